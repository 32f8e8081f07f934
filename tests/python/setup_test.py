"""scripts/setup.sh: the progress of the build on a terminal, and one line elsewhere; programs that a distribution lacks."""

import os
import pathlib
import pty
import re
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("TRAVERSE_SOURCE_DIR", pathlib.Path(__file__).parents[2])).resolve()
NINJA = ["[0/2] Re-checking globbed directories...", "[1/4] Building CXX object a.o", "a.cpp:1: a warning",
         "[2/4] Building CXX object b.o", "[3/4] Building CXX object c.o", "[4/4] Linking CXX executable traverse"]


class Progress(unittest.TestCase):
    def said(self, lines, terminal):
        """What show_progress says of the lines of Ninja, which it copies to its log."""
        with tempfile.TemporaryDirectory() as folder:
            log = pathlib.Path(folder) / "setup.log"
            script = 'source "$1/scripts/setup.sh"; setup_log=$2; show_progress'
            try:
                reader, writer = pty.openpty() if terminal else os.pipe()
            except OSError as failure:  # in a folder that chroot has made the root
                self.skipTest(str(failure))
            subprocess.run(["bash", "-euo", "pipefail", "-c", script, "bash", SOURCE, log], stderr=writer, check=True,
                           input="".join(f"{line}\n" for line in lines), text=True, stdout=subprocess.DEVNULL)
            os.close(writer)
            said = b""
            try:
                while part := os.read(reader, 4096):
                    said += part
            except OSError:  # a terminal that nobody else has open
                pass
            os.close(reader)
            self.assertEqual(log.read_text().splitlines(), lines)
            return said.decode().replace(str(log), "LOG")

    def test_a_terminal_shows_how_much_is_done(self):
        said = self.said(NINJA, True)
        self.assertEqual(said.count("\n"), 1)
        shown = re.findall(r"\rBuilding Traverse \[(\d)/4\], \d+ min \d\d s left, log in LOG", said)
        self.assertEqual(shown, ["1", "2", "3", "4"])
        self.assertIn("[4/4], 0 min 00 s left", said)

    def test_a_file_has_one_line(self):
        self.assertEqual(self.said(NINJA, False), "Building Traverse, log in LOG\n")

    def test_nothing_to_build_is_silent(self):
        for terminal in (False, True):
            self.assertEqual(self.said(["[0/1] Re-checking globbed directories...", "ninja: no work to do."], terminal), "")


class OtherPrograms(unittest.TestCase):
    def test_what_the_distribution_lacks_is_left_out(self):
        script = """source "$1/scripts/setup.sh"
            apt-cache() { [ "$2" = known ]; }
            install_packages() { echo "installs $*"; }
            install_offered missing known
            install_offered missing"""
        said = subprocess.run(["bash", "-euo", "pipefail", "-c", script, "bash", SOURCE], capture_output=True, text=True)
        self.assertEqual((said.returncode, said.stdout, said.stderr), (0, "installs known\n", ""))


if __name__ == "__main__":
    unittest.main()
