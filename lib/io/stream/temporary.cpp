// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/stream/private/temporary.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <mutex>
#include <set>

#include "base/system_error.hpp"

namespace vam::io {

namespace fs = std::filesystem;

namespace {

// A signal handler may neither lock nor allocate, so the names live in fixed places. A name that finds no free place,
// or is too long, is still removed by its owner's destructor, only not after a signal.
struct Listed {
  std::atomic<bool> taken{false};
  std::atomic<bool> live{false};
  std::atomic<int> lock{-1};  // a descriptor whose lock says that this process still wants the name
  char path[PATH_MAX] = {};
};
std::array<Listed, 64> list;  // NOLINT: one per process, like the signal dispositions it serves

// Without opendir(), which allocates.
void empty_folder(const char* path) {
  alignas(dirent64) static char entries[1 << 15];
  const int folder = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  long bytes = 0;
  while ((bytes = syscall(SYS_getdents64, folder, entries, sizeof entries)) > 0) {
    for (long at = 0; at < bytes;) {
      const auto* entry = reinterpret_cast<const dirent64*>(entries + at);  // the kernel's linux_dirent64
      unlinkat(folder, entry->d_name, 0);                                   // refuses "." and "..", as folders
      at += entry->d_reclen;
    }
  }
  close(folder);
}

// Other threads may go on writing into a folder until the process ends.
void remove_listed(const char* path) {
  if (unlink(path) == 0 || errno != EISDIR) return;
  constexpr int attempts = 100;
  for (int i = 0; i < attempts && rmdir(path) != 0 && errno == ENOTEMPTY; ++i) empty_folder(path);
}

extern "C" void remove_and_die(int signal_number) {
  for (Listed& item : list) {
    if (item.live.load()) remove_listed(item.path);
  }
  // The disposition is the default again (SA_RESETHAND); once the handler returns the signal ends the process, and the
  // parent sees why.
  raise(signal_number);
}

void install_handlers() {
  for (const int number : {SIGHUP, SIGINT, SIGTERM}) {
    struct sigaction current = {};
    if (sigaction(number, nullptr, &current) != 0 || current.sa_handler != SIG_DFL) continue;  // nohup, a device tool
    struct sigaction ours = {};
    ours.sa_handler = remove_and_die;
    ours.sa_flags = static_cast<int>(SA_RESETHAND);
    sigemptyset(&ours.sa_mask);
    sigaction(number, &ours, nullptr);
  }
}

int enlist(const std::string& path) {
  if (path.size() >= PATH_MAX) return -1;
  install_handlers();
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i].taken.exchange(true)) continue;
    std::memcpy(list[i].path, path.c_str(), path.size() + 1);
    list[i].live = true;
    return static_cast<int>(i);
  }
  return -1;
}

std::string directory_of(const std::string& path) {
  const auto slash = path.rfind('/');
  return slash == std::string::npos ? "" : path.substr(0, slash + 1);
}

// A zombie, which has ended and only not been waited for, does not.
bool runs(int pid) {
  if (kill(pid, 0) != 0 && errno == ESRCH) return false;
  std::ifstream facts("/proc/" + std::to_string(pid) + "/stat");
  std::string line;
  std::getline(facts, line);
  const std::size_t name_end = line.rfind(')');  // the name before it may hold anything
  return name_end == std::string::npos || line.compare(name_end, 3, ") Z") != 0;
}

// The name is of a process that ended without removing it: none of that number runs here, and none on this machine or
// another that shares the folder holds its lock. A folder and the older one that stepped aside for it stay where both
// are there: neither has a name of its own.
bool is_left_over(const fs::path& path) {
  int pid = 0;
  unsigned count = 0;
  int read = 0;
  const std::string name = path.filename().string();
  if (std::sscanf(name.c_str(), ".vam-%d-%u%n", &pid, &count, &read) != 2) return false;
  constexpr std::string_view old = "-old";
  const bool aside = name.ends_with(old);
  if (!aside && name[read] != '\0') return false;
  if (pid <= 0 || runs(pid)) return false;
  std::error_code ignored;
  if (fs::exists(path.parent_path() / (aside ? name.substr(0, name.size() - old.size()) : name + std::string(old)),
                 ignored))
    return false;
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  const bool free = file >= 0 && flock(file, LOCK_EX | LOCK_NB) == 0;
  if (file >= 0) close(file);
  return free;
}

// Once a folder and process.
void sweep(const std::string& folder) {
  static std::mutex mutex;
  static std::set<std::string> swept;  // NOLINT: one per process
  const std::scoped_lock lock(mutex);
  if (!swept.insert(folder).second) return;
  DIR* const entries = opendir(folder.empty() ? "." : folder.c_str());
  if (entries == nullptr) return;
  while (const dirent* entry = readdir(entries)) {
    if (std::strncmp(entry->d_name, ".vam-", 5) != 0) continue;
    const fs::path path = fs::path(folder) / entry->d_name;
    std::error_code ignored;
    if (is_left_over(path)) fs::remove_all(path, ignored);
  }
  closedir(entries);
}

// Tries names until `create` meets one that does not exist. The name is listed before the file exists: a signal between
// the two then removes nothing, while the other order could leave a file behind.
int with_new_name(const std::string& target, std::string& name, int& slot,
                  const std::function<int(const char*)>& create) {
  static std::atomic<unsigned> counter{0};
  sweep(directory_of(target));
  while (true) {
    name = directory_of(target) + ".vam-" + std::to_string(getpid()) + "-" + std::to_string(counter++);
    if (faccessat(AT_FDCWD, name.c_str(), F_OK, AT_SYMLINK_NOFOLLOW) == 0) continue;  // left by a namesake; not ours
    slot = enlist(name);
    const int result = create(name.c_str());
    if (result >= 0) return result;
    const int problem = errno;
    forget_temporary(slot);
    slot = -1;
    name.clear();
    if (problem == EEXIST) continue;
    errno = problem;
    return -1;
  }
}

}  // namespace

int create_temporary(const std::string& target, std::string& name, int& slot) {
  return with_new_name(target, name, slot, [](const char* path) {
    const int file = open(path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file >= 0) (void)flock(file, LOCK_EX | LOCK_NB);
    return file;
  });
}

int create_temporary_folder(const std::string& target, std::string& name, int& slot) {
  const int made = with_new_name(target, name, slot, [](const char* path) { return mkdir(path, 0777); });
  if (made < 0 || slot < 0) return made;
  const int folder = open(name.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) {  // and without a descriptor to give up, what is in the folder could not be removed
    const int problem = errno;
    (void)rmdir(name.c_str());
    forget_temporary(slot);
    slot = -1;
    name.clear();
    errno = problem;
    return -1;
  }
  (void)flock(folder, LOCK_EX | LOCK_NB);
  list[slot].lock = folder;
  return made;
}

int name_temporary(int descriptor, const std::string& target, std::string& name, int& slot) {
  const std::string self = "/proc/self/fd/" + std::to_string(descriptor);
  (void)flock(descriptor, LOCK_EX | LOCK_NB);
  return with_new_name(target, name, slot, [&self](const char* path) {
    return linkat(AT_FDCWD, self.c_str(), AT_FDCWD, path, AT_SYMLINK_FOLLOW);
  });
}

void sweep_folder_of(const std::string& target) { sweep(directory_of(target)); }

void synchronise_folder_of(const std::string& target) {
  const std::string folder = directory_of(target);
  const int descriptor = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  const int error = fsync(descriptor) == 0 || errno == EINVAL || errno == EROFS ? 0 : errno;
  close(descriptor);
  if (error != 0) throw system_error(Fault::io, target + ": its folder cannot be brought to the disk", error);
}

void forget_temporary(int slot) {
  if (slot < 0) return;
  Listed& item = list[slot];
  if (const int lock = item.lock.exchange(-1); lock >= 0) close(lock);
  item.live = false;
  item.taken = false;
}

}  // namespace vam::io
