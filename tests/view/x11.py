"""What xdotool cannot do: the resolution that a desktop asks for, and a file that is dropped on a window (XDND)."""

import ctypes
import ctypes.util
import time

CLIENT_MESSAGE, SELECTION_REQUEST, SELECTION_NOTIFY = 33, 30, 31
COPY_FROM_PARENT = 0


class X11:
    """A client of its own. Events are arrays of longs, as Xlib lays them out where a long has 64 bits."""

    def __init__(self, display):
        self.lib = ctypes.CDLL(ctypes.util.find_library("X11") or "libX11.so.6")
        self.lib.XOpenDisplay.restype = ctypes.c_void_p
        self.lib.XDefaultRootWindow.restype = self.lib.XInternAtom.restype = ctypes.c_ulong
        self.lib.XCreateSimpleWindow.restype = ctypes.c_ulong
        self.connection = ctypes.c_void_p(self.lib.XOpenDisplay(display.encode()))
        if not self.connection:
            raise OSError(f"no display {display}")
        self.root = ctypes.c_ulong(self.lib.XDefaultRootWindow(self.connection))

    def close(self):
        self.lib.XCloseDisplay(self.connection)

    def atom(self, name):
        return self.lib.XInternAtom(self.connection, name.encode(), 0)

    def change_property(self, window, name, kind, data):
        self.lib.XChangeProperty(self.connection, ctypes.c_ulong(window), ctypes.c_ulong(name), ctypes.c_ulong(kind), 8, 0,
                                 data, len(data))
        self.lib.XSync(self.connection, 0)

    def set_dots_per_inch(self, number):
        self.change_property(self.root.value, self.atom("RESOURCE_MANAGER"), self.atom("STRING"),
                             f"Xft.dpi:\t{number}\n".encode())

    def send(self, window, kind, *fields):
        event = (ctypes.c_long * 24)(kind, 0, 0, 0, *fields)
        self.lib.XSendEvent(self.connection, ctypes.c_ulong(window), 0, ctypes.c_long(0), event)
        self.lib.XSync(self.connection, 0)

    def message(self, window, name, *data):
        self.send(window, CLIENT_MESSAGE, window, self.atom(name), 32, *data)

    def wait(self, kind, seconds=10):
        event = (ctypes.c_long * 24)()
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            while self.lib.XPending(self.connection):
                self.lib.XNextEvent(self.connection, event)
                if event[0] & 0xffffffff == kind:
                    return list(event)
            time.sleep(0.01)
        raise AssertionError("the window does not answer what is dropped on it")

    def drop(self, window, file):
        """As a file manager does it, in the middle of the window."""
        source = self.lib.XCreateSimpleWindow(self.connection, self.root, 0, 0, 1, 1, 0, ctypes.c_ulong(0),
                                              ctypes.c_ulong(0))
        selection, files = self.atom("XdndSelection"), self.atom("text/uri-list")
        self.lib.XSetSelectionOwner(self.connection, ctypes.c_ulong(selection), ctypes.c_ulong(source), ctypes.c_ulong(0))
        self.message(window, "XdndEnter", source, 5 << 24, files, 0, 0)
        self.message(window, "XdndPosition", source, 0, (400 << 16) | 300, 0, self.atom("XdndActionCopy"))
        self.wait(CLIENT_MESSAGE)  # XdndStatus
        self.message(window, "XdndDrop", source, 0, 0, 0, 0)
        request = self.wait(SELECTION_REQUEST)
        requestor, target, name = request[5], request[7], request[8]
        self.change_property(requestor, name, target, f"file://{file}\r\n".encode())
        self.send(requestor, SELECTION_NOTIFY, requestor, selection, target, name, 0)
        self.wait(CLIENT_MESSAGE)  # XdndFinished
