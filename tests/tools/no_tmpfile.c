// SPDX-License-Identifier: GPL-3.0-or-later
// A file system like NFS or vfat, for LD_PRELOAD: it knows no files without a name, no second names and no modes.
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

static int opened(int folder, const char *path, int flags, va_list arguments) {
  if ((flags & O_TMPFILE) == O_TMPFILE) {
    errno = EOPNOTSUPP;
    return -1;
  }
  return (int)syscall(SYS_openat, folder, path, flags, (flags & O_CREAT) != 0 ? va_arg(arguments, int) : 0);
}

int open(const char *path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int file = opened(AT_FDCWD, path, flags, arguments);
  va_end(arguments);
  return file;
}

int open64(const char *path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int file = opened(AT_FDCWD, path, flags, arguments);
  va_end(arguments);
  return file;
}

int fchmod(int file, mode_t mode) {
  (void)file, (void)mode;
  errno = EPERM;
  return -1;
}

int linkat(int from_folder, const char *from, int to_folder, const char *to, int flags) {
  (void)from_folder, (void)from, (void)to_folder, (void)to, (void)flags;
  errno = EPERM;
  return -1;
}
