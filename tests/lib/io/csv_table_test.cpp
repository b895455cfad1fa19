// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/csv_table.hpp"

#include "lib/io/scratch.hpp"
#include "testing.hpp"

using namespace vam;

namespace {

struct File {
  explicit File(const std::string& text) : path(folder.write("table.csv", text)) {}
  scratch::Folder folder;
  std::string path;
};

std::string message(const std::string& text) {
  const File file(text);
  const auto read = [&] {
    const io::CsvTable table = io::read_csv(file.path, {"a", "b"});
    for (std::size_t row = 0; row < table.rows.size(); ++row) (void)(table.number(row, 0) + table.number(row, 1));
  };
  return error_of(read, Fault::data).substr(file.path.size());
}

}  // namespace

TEST_CASE("columns are found by name, whatever their order") {
  const File file("# measured on a Tuesday\n\nnote, b ,a\r\nx,2,1\r\ny,4,3e1\n");
  const io::CsvTable table = io::read_csv(file.path, {"a", "b"});
  REQUIRE(table.rows.size() == 2);
  CHECK(table.number(0, 0) == 1);
  CHECK(table.number(0, 1) == 2);
  CHECK(table.number(1, 0) == 30);
  CHECK(table.lines == std::vector<int>{4, 5});
}

TEST_CASE("a table of numbers alone needs no header") {
  const File file("1,2\n3,4\n");
  CHECK(io::read_csv(file.path, {"a", "b"}).number(1, 0) == 3);
}

TEST_CASE("damaged tables report the line") {
  CHECK(message("remark,note\n1,2\n") == ":1: no column 'a'; the header must name a,b");
  CHECK(message("a,b\n1\n") == ":2: 1 cells; give a,b");
  CHECK(message("a,b\n1,two\n") == ":2: b 'two' is not a number");
  CHECK(message("a,b\n1,inf\n") == ":2: b 'inf' is not a number");
  CHECK(message("a,b\n") == ": no rows; give a,b");
  CHECK(message("") == ": no rows; give a,b");
}
