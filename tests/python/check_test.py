"""-describe on a terminal: its characters and colours are for terminals alone, and only as far as these show them."""

import fcntl
import os
import pathlib
import pty
import struct
import subprocess
import tempfile
import termios
import unittest

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
BINARY = os.environ.get("TRAVERSE_BINARY", str(SOURCE / "build/traverse"))
SCENE = SOURCE / "options/scenes/three_span_half_car.yml"


def on_terminal(columns=100, **environment):
    """What -describe writes to a terminal."""
    leader, follower = pty.openpty()
    fcntl.ioctl(follower, termios.TIOCSWINSZ, struct.pack("HHHH", 40, columns, 0, 0))
    wanted = {name: value for name, value in os.environ.items() if name not in ("LC_ALL", "LC_CTYPE", "LANG", "NO_COLOR")}
    with tempfile.TemporaryDirectory() as folder:
        child = subprocess.Popen([BINARY, "-options_file", SCENE, "-describe"], stdout=follower, stderr=subprocess.PIPE, cwd=folder,
                                 env=wanted | {"TERM": "xterm"} | environment)
        os.close(follower)
        written = b""
        while True:
            try:
                part = os.read(leader, 65536)
            except OSError:  # the terminal is closed
                break
            if not part:
                break
            written += part
        os.close(leader)
        complaints = child.stderr.read()
        child.stderr.close()
        assert child.wait() == 0 and complaints == b"", complaints
    return written.decode("utf-8").replace("\r\n", "\n")


class OnATerminal(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        try:
            for end in pty.openpty():
                os.close(end)
        except OSError as error:
            raise unittest.SkipTest(f"no terminal can be opened here: {error}") from None

    def test_a_terminal_of_utf8_shows_lines(self):
        text = on_terminal(LANG="C.UTF-8")
        self.assertIn("━━━━", text)
        self.assertIn("▲ pinned", text)
        self.assertIn("\033[1m", text)

    def test_another_one_shows_ascii(self):
        text = on_terminal(LANG="C")
        self.assertTrue(text.isascii())
        self.assertIn("====", text)
        self.assertIn("^ pinned", text)

    def test_colours_can_be_turned_off(self):
        for words in ({"NO_COLOR": "1"}, {"TERM": "dumb"}):
            self.assertNotIn("\033[1m", on_terminal(LANG="C.UTF-8", **words))

    def test_the_picture_fits(self):
        def widest(columns):
            lines = on_terminal(columns, LANG="C.UTF-8", NO_COLOR="1").split("\n")
            return max(len(line) for line in lines if "━━━━" in line)

        self.assertEqual(widest(100), 99)
        self.assertEqual(widest(60), 59)


if __name__ == "__main__":
    unittest.main()
