"""Images and keypoints made of integers alone, as modules/iib/test/support/test_images.cpp makes them."""
import contextlib
import csv
import importlib
import io
import shutil
import signal
import tempfile
import threading
import time
import unittest
from pathlib import Path

import numpy as np

REPOSITORY = Path(__file__).resolve().parents[2]


def optional(name):
    """A module, or None if it is not installed."""
    try:
        return importlib.import_module(name)
    except ImportError:
        return None


cv2 = optional('cv2')
resource = optional('resource')  # not on Windows


class Commands(unittest.TestCase):

    def check_mistake(self, pattern, *arguments):
        """Checks that the command reports a mistake in the command line."""
        self.check_error(pattern, *arguments, expected=2)

    def check_error(self, pattern, *arguments, expected=1):
        """Checks that opencv-iib ends with this status, and with one line about it after the progress."""
        status, _, errors = run_command(*arguments)
        self.assertEqual(status, expected)
        self.assertRegex(errors, rf'^(\w+ \d+.*\n)*{arguments[0]}: .*{pattern}.*\n$')


class InFolder(Commands):
    """Gives each test a folder of its own."""

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)  # Windows keeps files that are still mapped

    def write(self, name, image):
        """Writes an image and returns its path."""
        cv2.imwrite(str(self.folder / name), image)
        return str(self.folder / name)

    def rows(self, name):
        return rows_of(self.folder, name)


def rows_of(folder, name):
    """Rows of a CSV file."""
    with open(Path(folder, name), newline='') as file:
        return list(csv.DictReader(file))


def run_command(*arguments):
    """Runs opencv-iib. :return: status, standard output, standard error."""
    from opencv_iib.__main__ import main
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        status = main([str(argument) for argument in arguments])
    return status, out.getvalue(), err.getvalue()


class Integers:
    """Pseudorandom integers, the same everywhere (SplitMix64)."""

    def __init__(self, seed):
        self.state = seed

    def below(self, end):
        mask = (1 << 64) - 1
        self.state = z = (self.state + 0x9e3779b97f4a7c15) & mask
        z = ((z ^ z >> 30) * 0xbf58476d1ce4e5b9) & mask
        z = ((z ^ z >> 27) * 0x94d049bb133111eb) & mask
        return (z ^ z >> 31) % end

    def between(self, begin, end):
        return begin + self.below(end - begin)


def _blurred(m, axis):
    padded = np.pad(m, [(2, 2) if a == axis else (0, 0) for a in range(2)], 'edge')
    size = m.shape[axis]
    total = sum(weight * np.take(padded, range(i, i + size), axis) for i, weight in enumerate((1, 4, 6, 4, 1)))
    return (total + 8) // 16


def texture(width, height, dtype=np.uint8, seed=1):
    """Blurred noise with a flat rectangle."""
    integers = Integers(seed)
    end = 256 if dtype == np.uint8 else 65536
    m = np.array([integers.below(end) for _ in range(width * height)], np.int64).reshape(height, width)
    m = _blurred(_blurred(m, 1), 0)
    m[height // 4:height // 4 + height // 3, width // 4:width // 4 + width // 3] = 77
    return m.astype(dtype)


def scatter(width, height, count, smallest, largest, seed):
    """count x 4 float32: x, y, size, angle, in and around an image."""
    integers = Integers(seed)
    rows = []
    for i in range(count):
        part = 4 if i % 4 else 1
        x = integers.between(-(width * part // 5), width * part * 6 // 5) / part
        y = integers.between(-(height * part // 5), height * part * 6 // 5) / part
        angle = integers.below(360) if i % 5 else -1
        rows.append((x, y, integers.between(int(smallest * 8), int(largest * 8)) / 8, angle))
    return np.array(rows, np.float32)


def grid(size=10):
    """48 x 3 float32 keypoints for an image of 160 x 120."""
    return np.array([(x, y, size) for y in range(0, 120, 20) for x in range(0, 160, 20)], np.float32)


def fnv1a(array):
    """FNV-1a, 64 bits."""
    value = 14695981039346656037
    for byte in array.tobytes():
        value = ((value ^ byte) * 1099511628211) & ((1 << 64) - 1)
    return value


def brute_force(query, train, k):
    """Indices and distances, queries x k."""
    bits = np.unpackbits(query[:, None] ^ train[None], axis=2).sum(axis=2, dtype=np.int32)
    order = np.argsort(bits, axis=1, kind='stable')[:, :k]
    return order, np.take_along_axis(bits, order, 1)


def seconds_until_interrupt(call, after):
    """How long `call` takes if Ctrl-C is pressed after so many seconds; fails if it ends normally."""
    if not hasattr(signal, 'SIGALRM'):
        raise unittest.SkipTest('no signal at a chosen time on this system')
    old, begin = signal.signal(signal.SIGALRM, signal.default_int_handler), time.monotonic()
    try:
        signal.setitimer(signal.ITIMER_REAL, after)
        call()
    except KeyboardInterrupt:
        return time.monotonic() - begin
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, old)
    raise AssertionError('it was not interrupted')


def steps_meanwhile(call):
    """How often another thread runs Python in the middle half of `call`'s time: 0 if the call holds the GIL.

    The first and last quarter do not count, since the other thread may get the GIL just before or after the call.
    """
    span, steps, ended = [], [], threading.Event()

    def work():
        span.append(time.perf_counter())
        call()
        span.append(time.perf_counter())
        ended.set()
    thread = threading.Thread(target=work)
    thread.start()
    while not ended.is_set():
        steps.append(time.perf_counter())
        time.sleep(.001)
    thread.join()
    begin, end = span
    return sum(abs(step - (begin + end) / 2) < (end - begin) / 4 for step in steps)


@contextlib.contextmanager
def files_end_at(size):
    """Simulates a full disk: no file can grow beyond so many bytes."""
    if resource is None:
        raise unittest.SkipTest('no limit of the size of files on this system')
    limits, old = resource.getrlimit(resource.RLIMIT_FSIZE), signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, limits[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        signal.signal(signal.SIGXFSZ, old)
