"""scripts/traverse-serve in a real browser: a form filled in by keyboard, its run, its results, its report, and the same
numbers on the command line."""

import io
import pathlib
import subprocess
import sys
import tempfile
import unittest
import zipfile

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from browser import Browser  # noqa: E402
from served import ENDLESS, Served  # noqa: E402
from small_runs import BINARY  # noqa: E402


def numbers(path):
    """{name: values} of all datasets of numbers of a results file but those of its options."""
    found = {}
    with h5py.File(path, "r") as file:
        file.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) and
                        item.dtype.kind in "fiu" and "option" not in name else None)
    return found


class InABrowser(Served):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)
        cls.js = cls.browser.evaluate

    def tab_to(self, name):
        """Goes to a field by the Tab key alone."""
        for _ in range(40):
            if self.js("document.activeElement.name || document.activeElement.id") == name:
                return
            self.browser.key("Tab")
        self.fail(f"the Tab key does not reach {name}")

    def wait(self, words):
        return self.until(lambda: self.js(words))

    def complaints(self):
        """Those of the page; the server is the only address that it asks."""
        return [one for one in self.browser.complaints() if not (isinstance(one, str) and one.startswith(self.address))]

    def fits(self, width):
        self.browser.resize(width)
        self.browser.frames()
        self.assertLessEqual(self.js("document.documentElement.scrollWidth"), width)

    def test_1_a_check_from_the_first_key_to_the_report(self):
        self.browser.visit(f"{self.address}en/")
        self.wait("byId('facts').children.length > 0 && view.stage !== null")
        self.tab_to("span")
        self.browser.type("20")
        self.wait("view.stage.stage.high === 20")
        self.tab_to("EI")
        self.browser.type("80 x")
        self.wait("byId('error-EI').textContent.includes('allowed: a number')")
        self.assertEqual(self.js("byId('EI').getAttribute('aria-invalid')"), "true")
        self.js("byId('EI').select()")
        self.browser.type("80")
        self.wait("byId('error-EI').textContent === ''")
        self.tab_to("line-speed")
        self.browser.type("220")
        self.wait("byId('facts').children[1].textContent.includes('264 km/h')")
        self.fits(390)
        self.browser.resize(1280)
        self.assertEqual(self.complaints(), [])
        self.browser.key("Enter")
        self.wait("location.pathname.endsWith('/run/1')")
        self.ended(1)
        self.wait("document.querySelector('iframe') !== null")
        for width in (390, 1280):
            self.fits(width)
        self.assertEqual(self.js("[...document.querySelectorAll('a[data-make]')].map((one) => one.textContent)"),
                         ["Report (PDF)", "Table (XLSX)"])
        self.js("document.querySelector('a[data-make]').click()")
        self.wait("document.querySelector('a[data-make]') === null")
        self.assertEqual(self.js("byId('making').textContent"), "")
        for name, first in (("report.pdf", b"%PDF"), ("report.xlsx", b"PK")):
            self.assertTrue(self.request("GET", f"en/run/1/file/{name}")[2].startswith(first))
        self.browser.visit(f"{self.address}en/run/1/file/check.html")
        self.assertEqual(self.js("data.tables[0].rows.length > 3 && page.all.length > 0"), True)
        self.assertEqual(self.complaints(), [])

    def test_2_the_scene_gives_the_same_numbers_on_the_command_line(self):
        content = self.request("GET", "en/run/1/scene.zip")[2]
        with tempfile.TemporaryDirectory() as folder, zipfile.ZipFile(io.BytesIO(content)) as archive:
            self.assertEqual(archive.namelist(), ["bridge.yml", "check.yml", "limits.yml"])
            archive.extractall(folder)
            ended = subprocess.run([BINARY, "-options_file", "check.yml", "-output_file", "again.h5"], cwd=folder,
                                   capture_output=True, text=True)
            self.assertEqual(ended.returncode, 0, ended.stderr)
            again, served = numbers(pathlib.Path(folder, "again.h5")), numbers(self.folder / "run_1/check.h5")
            self.assertEqual(set(again), set(served))
            self.assertGreater(served["sweep/speed"].size, 30)
            for name, values in served.items():
                np.testing.assert_array_equal(values, again[name], name)

    def test_3_an_endless_run_is_stopped_by_its_button(self):
        self.browser.visit(f"{self.address}de/scene")
        self.js(f"byId('text').value = {ENDLESS!r}; byId('text').dispatchEvent(new Event('input', {{bubbles: true}}))")
        self.wait("view.stage !== null && view.stage.stage.high === 20")
        self.tab_to("go")
        self.browser.key("Enter")
        self.wait("document.getElementById('stop') !== null")
        run = self.js("location.pathname.split('/').pop()")
        self.until(lambda: self.state(run)["state"] == "running")
        self.tab_to("stop")
        self.browser.key("Enter")
        self.wait("document.getElementById('state')?.textContent.includes('abgebrochen')")
        self.assertEqual(self.state(run)["state"], "stopped")

    def test_4_every_form_opens_in_every_language(self):
        for language in ("en", "de", "fr"):
            for form in ("check", "sweep", "find", "rough", "crane", "scene", "runs"):
                with self.subTest(form, language=language):
                    self.browser.visit(f"{self.address}{language}/{form}", 390)
                    self.browser.scheme("dark")
                    self.fits(390)
                    self.assertEqual(self.js("document.documentElement.lang"), language)
                    left, right = self.js("(() => { const box = document.querySelector('nav [aria-current]').getBoundingClientRect(); "
                                          "return [box.left, box.right]; })()")
                    self.assertTrue(0 <= left < right <= 390, (left, right))
                    unnamed = "[...document.querySelectorAll('input, select, textarea')].filter((one) => !one.labels.length && " \
                              "!one.getAttribute('aria-label')).length"
                    self.assertEqual(self.js(unnamed), 0)
                    self.assertEqual(self.complaints(), [])
        self.browser.scheme("light")


if __name__ == "__main__":
    unittest.main()
