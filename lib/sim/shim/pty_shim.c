// SPDX-License-Identifier: GPL-3.0-or-later
// Lets libserialport 0.1.1 open a pseudo-terminal, for LD_PRELOAD. The library looks for the port in /sys/class/tty,
// where pseudo-terminals are not, and asks for modem lines, which they do not have: answer both.
// TIOCEXCL lasts until a line is closed on both sides, which the simulator's never is: the next user, unless it is root,
// would not get in. It is not passed on.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <stdarg.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

static const char *in_sys(const char *path) {
  static const char tree[] = "/sys/class/tty/pts/";
  return strncmp(path, tree, sizeof tree - 1) == 0 ? "/sys/class/tty/tty" : path;
}

int __lxstat(int version, const char *path, struct stat *about);
int __lxstat(int version, const char *path, struct stat *about) {
  (void)version;
  return lstat(in_sys(path), about);
}

ssize_t readlink(const char *path, char *target, size_t size) {
  return readlinkat(AT_FDCWD, in_sys(path), target, size);
}

int ioctl(int fd, unsigned long request, ...) {
  va_list arguments;
  va_start(arguments, request);
  void *argument = va_arg(arguments, void *);
  va_end(arguments);
  static int (*real)(int, unsigned long, ...);
  if (real == NULL) *(void **)&real = dlsym(RTLD_NEXT, "ioctl");
  if (request == TIOCEXCL) return 0;
  const int result = real(fd, request, argument);
  const int modem = request == TIOCMGET || request == TIOCMSET || request == TIOCMBIS || request == TIOCMBIC;
  if (result == 0 || !modem) return result;
  if (request == TIOCMGET) *(int *)argument = TIOCM_DTR | TIOCM_RTS | TIOCM_CTS | TIOCM_DSR;
  return 0;
}
