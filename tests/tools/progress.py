# SPDX-License-Identifier: GPL-3.0-or-later
"""What a terminal shows of commands. usage: progress.py COLUMNS COMMAND [taken]: runs the shell command with standard
error (and input) a terminal so wide, and prints what is written from each return of the cursor to the next, with $ where
the row is cleared. taken: another process has the line."""
import fcntl
import os
import pty
import struct
import subprocess
import sys
import termios
import threading

columns, command = int(sys.argv[1]), sys.argv[2]
leader, terminal = pty.openpty()
other = None
fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack('HHHH', 24, columns, 0, 0))
if sys.argv[3:] == ['taken']:
    other = os.open(os.ttyname(terminal), os.O_WRONLY | os.O_NOCTTY)
    fcntl.flock(other, fcntl.LOCK_EX)
child = subprocess.Popen(command, shell=True, stdin=terminal, stderr=terminal, stdout=subprocess.DEVNULL)
os.close(terminal)
if other is not None:  # a read of the leader ends when nobody has the terminal any more
    threading.Thread(target=lambda: (child.wait(), os.close(other))).start()
written = b''
try:
    while chunk := os.read(leader, 65536):
        written += chunk
except OSError:
    pass  # the last process has closed it
status = child.wait()
for row in written.decode().replace('\r\n', '\n').split('\r'):
    print(row.replace('\x1b[K', '$'))
sys.exit(status)
