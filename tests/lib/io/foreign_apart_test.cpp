// SPDX-License-Identifier: GPL-3.0-or-later
// Images and stacks are parsed in a child.
#include <sys/resource.h>

#include "io/image/image_file.hpp"
#include "io/stream/seal.hpp"
#include "lib/io/exr_stacks.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::io;
using namespace vam::stacks;

namespace {

// Grows with every child that has been waited for.
long childrens_faults() {
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  return used.ru_minflt;
}

template <class Work>
bool has_child(const Work& work) {
  const long before = childrens_faults();
  work();
  return childrens_faults() > before;
}

// As of another program, which knows nothing of seals.
std::string without_seals(std::string bytes) {
  for (std::size_t at = 0; (at = bytes.find("vam:", at)) != std::string::npos; ++at) {
    if (is_seal_key(bytes.substr(at, bytes.find('\0', at) - at))) bytes.replace(at, 3, "oth");
  }
  return bytes;
}

// The numbers of all images, and what is reported about them.
std::vector<float> values_of(const std::string& path, model::StackInfo& info, std::vector<double>& angles) {
  StackReader reader(path);
  info = reader.info();
  std::vector<float> values;
  Image image;
  for (model::ImageInfo about; reader.next(image, about);) {
    values.insert(values.end(), image.values.begin(), image.values.end());
    angles.push_back(about.z_mm);
  }
  return values;
}

}  // namespace

TEST_CASE("an image is decoded in a child") {
  const scratch::Folder folder;
  write_png(folder / "a.png", GreyImage(5, 4, 8));
  CHECK(has_child([&] { (void)read_image(folder / "a.png"); }));
}

TEST_CASE("a stack is parsed in a child, and is the same without seals") {
  const scratch::Folder folder;
  for (const char* compression : {"none", "zip", "piz"}) {
    model::StackInfo info = sinogram(9, 35, 20);
    info.history = {"a line", "and another"};
    info.extra["vam:printer"] = "vial.radius_mm=6";
    for (int a = 0; a < info.height; ++a) {
      info.poses.push_back({info.angle_start_deg + a * info.angle_step_deg, 0.1, 0, 0.01 * a, model::Moves::part});
    }
    {
      StackWriter writer(folder / "own.exr", info, {false, compression});
      for (int k = 0; k < info.count; ++k) {
        Image image(9, 35);
        for (std::size_t i = 0; i < image.size(); ++i)
          image.values[i] = static_cast<float>(k) + 0.5F * static_cast<float>(i);
        writer.write(image);
      }
      writer.commit();
    }
    const std::string bytes = without_seals(slurp(folder / "own.exr"));
    spill(folder / "other.exr", bytes);
    model::StackInfo own;
    model::StackInfo other;
    std::vector<double> own_z;
    std::vector<double> other_z;
    std::vector<float> own_values;
    std::vector<float> other_values;
    CHECK(has_child([&] { own_values = values_of(folder / "own.exr", own, own_z); }));
    CHECK(has_child([&] { other_values = values_of(folder / "other.exr", other, other_z); }));
    CHECK(own_values == other_values);
    CHECK(own_values.size() == std::size_t{9} * 35 * 20);
    CHECK(own_z == other_z);
    CHECK(other.poses == own.poses);
    CHECK(other.poses == info.poses);
    CHECK(other.history == info.history);  // no line of a seal
    CHECK(other.extra.at("vam:printer") == "vial.radius_mm=6");
    CHECK(other.z_start_mm == own.z_start_mm);
    CHECK(other.count == 20);

    spill(folder / "two.exr", bytes + bytes);
    StackReader two(folder / "two.exr", true);
    CHECK(!two.is_sealed());
    CHECK(two.seal().empty());
    Image image;
    model::ImageInfo about;
    int images = 0;
    do {
      while (two.next(image, about)) ++images;
    } while (two.next_stack());
    CHECK(images == 40);

    spill(folder / "cut.exr", bytes.substr(0, bytes.size() - 5));
    CHECK(has(error_of([&] { (void)values_of(folder / "cut.exr", own, own_z); }, Fault::data),
              "is cut off after " + std::to_string(bytes.size() - 5) + " bytes, in image 19 of 20"));
  }
}
