// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/stream/stream.hpp"

#include <sys/stat.h>
#include <sys/wait.h>

#include <csignal>
#include <thread>

#include "io/stream/private/temporary.hpp"
#include "lib/io/scratch.hpp"
#include "testing.hpp"

using namespace vam::io;
using scratch::slurp;
using scratch::spill;
using scratch::status;
using Temporary = OutputFile::Temporary;

TEST_CASE("a file appears under its name only at commit, whole") {
  for (const auto temporary : {Temporary::unnamed, Temporary::named}) {
    const scratch::Folder folder;
    {
      OutputFile file(folder / "a.txt", Content::binary, temporary);
      file.write("first ");
      file.write(std::string(1 << 20, 'x'));  // larger than the buffer
      file.write_at(0, "FIRST", 5);
      CHECK_FALSE(std::filesystem::exists(folder / "a.txt"));
      CHECK(file.position() == 6 + (1 << 20));
      file.commit();
    }
    CHECK(slurp(folder / "a.txt") == "FIRST " + std::string(1 << 20, 'x'));
    CHECK(folder.count() == 1);
  }
}

TEST_CASE("without commit no new file is left and the old one stays") {
  for (const auto temporary : {Temporary::unnamed, Temporary::named}) {
    const scratch::Folder folder;
    spill(folder / "a.txt", "old");
    { OutputFile(folder / "a.txt", Content::binary, temporary).write("new"); }
    CHECK(slurp(folder / "a.txt") == "old");
    CHECK(folder.count() == 1);
  }
}

TEST_CASE("commit replaces a file, keeps its mode and follows a link to it") {
  const scratch::Folder folder;
  spill(folder / "a.txt", "old");
  chmod((folder / "a.txt").c_str(), 0640);
  std::filesystem::create_symlink("a.txt", folder / "link.txt");
  OutputFile file(folder / "link.txt");
  file.write("new");
  file.commit();
  CHECK(slurp(folder / "a.txt") == "new");
  CHECK(std::filesystem::is_symlink(folder / "link.txt"));
  struct stat about = {};
  stat((folder / "a.txt").c_str(), &about);
  CHECK((about.st_mode & 07777) == 0640);
  CHECK(folder.count() == 2);
}

TEST_CASE("a dangling link is followed to a new file") {
  const scratch::Folder folder;
  std::filesystem::create_symlink("later.txt", folder / "link.txt");
  OutputFile file(folder / "link.txt");
  file.write("new");
  file.commit();
  CHECK(slurp(folder / "later.txt") == "new");
}

TEST_CASE("two outputs at once, and one after the other under the same name") {
  const scratch::Folder folder;
  OutputFile one(folder / "a", Content::binary, Temporary::named);
  OutputFile two(folder / "a", Content::binary, Temporary::named);
  one.write("1");
  two.write("2");
  one.commit();
  CHECK(slurp(folder / "a") == "1");
  two.commit();
  CHECK(slurp(folder / "a") == "2");
  CHECK(folder.count() == 1);
}

TEST_CASE("an output that cannot be created is 73") {
  const scratch::Folder folder;
  CHECK(has(error_of([&] { const OutputFile file(folder / "absent/a.txt"); }, vam::Fault::no_output),
            "No such file or directory"));
  CHECK(status([&] { const OutputFile file(folder.path.string()); }) == 73);
}

TEST_CASE("a full device is 74 and is not renamed over") {
  struct stat before = {};
  struct stat after = {};
  stat("/dev/full", &before);
  CHECK(error_of(
            [] {
              OutputFile file("/dev/full");
              CHECK(file.is_stream());
              file.write("x");
              file.commit();
            },
            vam::Fault::io) == "/dev/full: cannot write: No space left on device");
  stat("/dev/full", &after);
  CHECK(S_ISCHR(after.st_mode));
  CHECK(before.st_ino == after.st_ino);
}

TEST_CASE("an input that cannot be opened is 66") {
  const scratch::Folder folder;
  CHECK(status([&] { const InputFile file(folder / "absent"); }) == 66);
  CHECK(status([&] { const InputFile file(folder.path.string()); }) == 66);
}

TEST_CASE("a signal removes named temporary files and still kills") {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    const scratch::Folder folder;
    const pid_t child = fork();
    if (child == 0) {
      // doctest has its own handlers for these in the parent; a tool starts with the defaults.
      for (const int each : {SIGINT, SIGTERM, SIGHUP}) std::signal(each, SIG_DFL);
      OutputFile one(folder / "a", Content::binary, Temporary::named);
      OutputFile two(folder / "b", Content::binary, Temporary::unnamed);
      const OutputFolder three(folder / "c", [](const std::filesystem::path&) { return true; });
      one.write("half");
      for (int i = 0; i < 3000; ++i) three.write(std::to_string(i), "");  // more than one getdents64
      if (folder.count() != 2) _exit(2);                                  // two has no name yet
      kill(getpid(), number);
      sleep(5);  // ThreadSanitizer delivers signals at the next wait
      _exit(3);
    }
    int ended = 0;
    waitpid(child, &ended, 0);
    CHECK(WIFSIGNALED(ended));
    CHECK(WTERMSIG(ended) == number);
    CHECK(folder.count() == 0);
  }
}

TEST_CASE("the place of a temporary name is free again once it is final") {
  const scratch::Folder folder;
  for (int i = 0; i < 3; ++i) {
    std::string name;
    int slot = -1;
    const int file = create_temporary(folder / "a.txt", name, slot);
    REQUIRE(file >= 0);
    CHECK(slot == 0);  // no other output is open
    close(file);
    std::filesystem::remove(name);
    forget_temporary(slot);
  }
}

TEST_CASE("an ignored signal stays ignored") {
  const scratch::Folder folder;
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGHUP, SIG_IGN);  // nohup
    OutputFile file(folder / "a", Content::binary, Temporary::named);
    raise(SIGHUP);
    file.commit();
    _exit(0);
  }
  int ended = 0;
  waitpid(child, &ended, 0);
  CHECK(WIFEXITED(ended));
  CHECK(std::filesystem::exists(folder / "a"));
}

TEST_CASE("kill -9 leaves no file on file systems with unnamed files") {
  const scratch::Folder folder;
  const int probe = open(folder.path.c_str(), O_TMPFILE | O_RDWR, 0600);
  if (probe < 0) {
    MESSAGE("skipped: no O_TMPFILE in " << folder.path);
    return;
  }
  close(probe);
  const pid_t child = fork();
  if (child == 0) {
    OutputFile file(folder / "a");
    file.write(std::string(1 << 20, 'x'));
    raise(SIGKILL);
  }
  waitpid(child, nullptr, 0);
  CHECK(folder.count() == 0);
}

TEST_CASE("removes temporaries of killed writers, keeps those of live ones") {
  const scratch::Folder folder;
  const auto any_file = [](const std::filesystem::path&) { return true; };
  const auto in_child = [&](bool dies) {
    std::array<int, 2> ready{};
    CHECK(pipe(ready.data()) == 0);
    const pid_t child = fork();
    if (child == 0) {
      OutputFile file(folder / "a.png", Content::binary, Temporary::named);
      const OutputFolder frames(folder / "frames", any_file);
      frames.write("00000.png", "x");
      (void)!write(ready[1], "x", 1);
      pause();
    }
    char byte = 0;
    CHECK(read(ready[0], &byte, 1) == 1);
    if (dies) {
      kill(child, SIGKILL);
      waitpid(child, nullptr, 0);
    }
    close(ready[0]);
    close(ready[1]);
    return child;
  };
  (void)in_child(true);
  const pid_t alive = in_child(false);
  std::filesystem::create_directory(folder / ".vam-999999-0-old");  // stepped aside for the next, which has no name yet
  spill(folder / ".vam-999999-0", "x");
  std::filesystem::create_directory(folder / ".vam-999999-1-old");  // what it stepped aside for took its name
  spill(folder / ".vam-999999-2", "x");
  std::filesystem::create_directory(folder / ".vam-999999-3.d-old");  // of a folder whose name ends with .d
  std::filesystem::create_directory(folder / ".vam-999999-3.d");
  CHECK(folder.count() == 8);  // the second process has tidied up after the first
  const pid_t next = fork();   // once a process
  if (next == 0) {
    { OutputFile file(folder / "b.png", Content::binary, Temporary::named); }
    _exit(0);
  }
  waitpid(next, nullptr, 0);
  CHECK(folder.count() == 6);
  CHECK(std::filesystem::exists(folder / ".vam-999999-3.d-old"));
  CHECK(std::filesystem::exists(folder / ".vam-999999-3.d"));
  CHECK(std::filesystem::exists(folder / ".vam-999999-0-old"));
  CHECK(std::filesystem::exists(folder / ".vam-999999-0"));
  int of_alive = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path)) {
    of_alive += entry.path().filename().string().starts_with(".vam-" + std::to_string(alive) + "-") ? 1 : 0;
  }
  CHECK(of_alive == 2);
  kill(alive, SIGKILL);
  waitpid(alive, nullptr, 0);
}

TEST_CASE("- is stdout, written directly, and stdin") {
  const scratch::Folder folder;
  {
    const scratch::Redirect to(STDOUT_FILENO, folder / "out");
    OutputFile file("-");
    CHECK(file.is_stream());
    CHECK(file.name() == "stdout");
    file.write("through");
    file.commit();
  }
  CHECK(slurp(folder / "out") == "through");
  const scratch::Redirect from(STDIN_FILENO, folder / "out");
  CHECK(read_all("-") == "through");
}

TEST_CASE("bytes come out as they went in, through a FIFO and any mix of read sizes") {
  const scratch::Folder folder;
  REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
  std::string sent(5'000'000, '\0');
  for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = static_cast<char>(i * 2654435761U >> 13);
  std::thread writer([&] {
    OutputFile file(folder / "pipe");
    CHECK(file.is_stream());
    for (std::size_t at = 0, step = 1; at < sent.size(); at += step, step = step * 3 % 700'001 + 1) {
      file.write(sent.data() + at, std::min(step, sent.size() - at));
    }
    file.commit();
  });
  std::string got(sent.size() + 10, '?');
  std::size_t at = 0;
  {
    InputFile file(folder / "pipe");
    for (std::size_t step = 1; !file.at_end(); step = step * 7 % 2'000'003 + 1) {
      const std::size_t wanted = std::min(step, got.size() - at);
      at += file.read(got.data() + at, wanted);
      CHECK(file.position() == at);
    }
  }
  writer.join();
  got.resize(at);
  CHECK(got == sent);
}

TEST_CASE("read_all has a limit") {
  const scratch::Folder folder;
  spill(folder / "a", std::string(3000, 'x'));
  CHECK(read_all(folder / "a", Content::text, 3000).size() == 3000);
  CHECK(status([&] { (void)read_all(folder / "a", Content::text, 2999); }) == 65);
}
