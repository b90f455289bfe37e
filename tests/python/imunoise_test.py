"""The package imunoise for Python: the same numbers as the program, NumPy in and out, Ctrl-C and progress."""

import io
import json
import os
import signal
import subprocess
import tempfile
import threading
import time
import unittest

import numpy as np

import imunoise

PROGRAM = os.environ["IMUNOISE_BINARY"]
MODEL = "WN(sigma2=4e-6) + RW(gamma2=1e-12)"


def plain(value):
    """Arrays as lists, to compare whole documents."""
    if isinstance(value, dict):
        return {key: plain(one) for key, one in value.items()}
    if isinstance(value, list):
        return [plain(one) for one in value]
    return value.tolist() if isinstance(value, np.ndarray) else value


class Files(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.run_program("simulate", "--model", MODEL, "--rate", "100", "--samples", "20000", "--replicates", "3",
                        "--seed", "5", "--unit", "rad/s", "--channel", "gyro_x", "--out", "run.h5")
        cls.files = [os.path.join(cls.folder.name, f"run_{k}.h5") for k in (1, 2, 3)]

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def run_program(cls, *arguments):
        done = subprocess.run([PROGRAM, *arguments], cwd=cls.folder.name, capture_output=True, text=True)
        if done.returncode != 0:
            raise AssertionError(done.stderr)
        return done.stdout

    def same_as_program(self, document, *arguments):
        self.assertEqual(plain(document), json.loads(self.run_program(*arguments, "--json")))

    def test_reads_and_simulates_the_same_samples(self):
        read = imunoise.read(*self.files)
        made = imunoise.simulate(MODEL, 100, 20000, replicates=3, seed=5, unit="rad/s", channel="gyro_x")
        self.assertEqual((read.channels, read.rate, len(read)), (["gyro_x"], 100.0, 3))
        self.assertEqual(read.unit("gyro_x"), "rad/s")
        for k in range(3):
            np.testing.assert_array_equal(read.samples("gyro_x", k), made.samples("gyro_x", k))
        self.assertNotEqual(made.samples("gyro_x", 0)[0], made.samples("gyro_x", 1)[0])

    def test_wavelet_variance_and_fit_are_those_of_the_program(self):
        read = imunoise.read(*self.files)
        self.same_as_program(imunoise.wavelet_variance(read, per_octave=2), "wv", *self.files, "--per-octave", "2")
        self.same_as_program(imunoise.wavelet_variance(read, robust=0.6), "wv", *self.files, "--robust", "0.6")
        self.same_as_program(imunoise.fit(read, "WN + RW"), "fit", *self.files, "--model", "WN + RW")
        self.same_as_program(imunoise.fit(read, "WN + RW", weights="diag", confidence=0.68, estimator="whittle"),
                             "fit", *self.files, "--model", "WN + RW", "--weights", "diag", "--confidence", "0.68",
                             "--estimator", "whittle")

    def test_arrays_give_what_files_give(self):
        read = imunoise.read(*self.files)
        made = imunoise.from_arrays({"gyro_x": [np.rad2deg(read.samples("gyro_x", k)) for k in range(3)]}, 100,
                                    "deg/s")
        one, other = imunoise.fit(made, "WN + RW"), imunoise.fit(read, "WN + RW")
        self.assertEqual(one["verdict"], "fits")
        np.testing.assert_allclose(one["budget"]["measured"], other["budget"]["measured"], rtol=1e-9)
        table = imunoise.from_arrays({"x": np.stack([read.samples("gyro_x", k) for k in range(3)])}, 100, {"x": "rad/s"})
        self.assertEqual(imunoise.fit(table, "WN + RW")["fitted_model"], other["fitted_model"])

    def test_diagnose_is_that_of_the_program(self):
        self.run_program("simulate", "--model", MODEL + " + line(f=7, amplitude=5e-4)", "--rate", "100", "--samples",
                         "20000", "--seed", "5", "--unit", "rad/s", "--channel", "gyro_x", "--out", "wave.h5")
        file = os.path.join(self.folder.name, "wave.h5")
        found = imunoise.diagnose(imunoise.read(file), "WN + RW")
        self.same_as_program(found, "diagnose", file, "--model", "WN + RW")
        self.assertIn("line", json.dumps(plain(found)))

    def test_array_is_that_of_the_program(self):
        self.run_program("simulate", "--model", MODEL, "--rate", "100", "--samples", "20000", "--seed", "6", "--unit",
                         "rad/s", "--channel", "b", "--out", "b.npy")
        made = imunoise.simulate(MODEL, 100, 20000, seed=5, unit="rad/s")
        second = imunoise.simulate(MODEL, 100, 20000, seed=6, unit="rad/s")
        columns = np.stack([made.samples("x"), second.samples("x")], axis=1)
        file = os.path.join(self.folder.name, "both.csv")
        np.savetxt(file, columns, delimiter=",", header="a,b", comments="", fmt="%.17g")
        both = imunoise.read(file, rate=100, units="rad/s")
        self.same_as_program(imunoise.array(both, "WN + RW[corr]"), "array", file, "--rate", "100", "--unit", "rad/s",
                             "--model", "WN + RW[corr]")

    def test_export_writes_the_file_of_the_program(self):
        fitted = imunoise.fit(imunoise.read(*self.files), "WN + RW")
        written = imunoise.export(fitted, "kalibr")
        with open(os.path.join(self.folder.name, "fit.json"), "w", encoding="utf-8") as file:
            json.dump(plain(fitted), file)
        printed = self.run_program("export", "fit.json", "--to", "kalibr")
        values = lambda text: [line for line in text.splitlines() if line and not line.startswith("#")]
        self.assertEqual(values(written), values(printed))
        self.assertIn("gyroscope_noise_density", written)
        with np.load(io.BytesIO(imunoise.export(fitted, "kf-numpy"))) as matrices:
            self.assertIn("Q", " ".join(matrices.files))
        with self.assertRaisesRegex(imunoise.Error, "kalibr"):
            imunoise.export(fitted, "kalibur")

    def test_a_study_tries_adds_and_undoes(self):
        study = imunoise.Study(imunoise.read(*self.files), "gyro_x", "WN")
        models = [one["rung"]["model"] for one in study.add("RW")["attempts"]]
        self.assertEqual(len(models), 2)
        study.undo()
        path = os.path.join(self.folder.name, "gyro.study")
        study.save(path)
        self.assertIn("WN", self.run_program("study", "show", path))
        with self.assertRaises(imunoise.Error):
            study.add("nonsense")


class Samples(unittest.TestCase):
    def test_samples_are_read_only_views(self):
        made = imunoise.simulate("WN(sigma2=1)", 10, 100)
        one, other = made.samples("x"), made.samples("x")
        self.assertTrue(np.shares_memory(one, other))
        with self.assertRaises(ValueError):
            one[0] = 1.0
        del made, other
        self.assertEqual(one.shape, (100,))
        self.assertTrue(np.isfinite(one.sum()))  # the samples outlive the recording

    def test_allan_deviation_is_that_of_its_definition(self):
        x = imunoise.simulate("WN(sigma2=1) + RW(gamma2=0.01)", 10, 4096, seed=3)
        found = imunoise.allan_deviation(x, "x")
        self.assertEqual(round(found["tau_s"][2] * 10), 4)  # the customary times: 1, 2, 4, 10, ...
        self.assertTrue(np.all(np.diff(found["degrees_of_freedom"]) < 0.0))
        self.assertEqual(len(imunoise.hadamard_deviation(x, "x")["deviation"]), len(found["deviation"]) - 1)
        sums = np.concatenate([[0.0], np.cumsum(x.samples("x"))])
        for tau, deviation in zip(found["tau_s"], found["deviation"]):
            m = round(tau * 10)
            second = (sums[2 * m:] - 2 * sums[m:-m] + sums[:-2 * m]) / m
            self.assertAlmostEqual(deviation / np.sqrt(0.5 * np.mean(second**2)), 1.0, places=9)

    def test_wrong_arguments_raise(self):
        noise = np.random.default_rng(1).normal(size=100)
        for channels, units, rate in (({}, "", 10), ({"x": noise[:8]}, "", 10), ({"x": noise}, "furlong", 10),
                                      ({"x": noise}, "", 0), ({"x": noise, "y": noise[:50]}, "", 10),
                                      ({"x": np.where(noise > 1, np.nan, noise)}, "", 10),
                                      ({"x": noise}, {"y": "rad/s"}, 10)):
            with self.assertRaises(imunoise.Error):
                imunoise.from_arrays(channels, rate, units)
        masked = np.ma.masked_greater(noise, 1.0)
        for channel, words in ((masked, "masked"), (noise.astype(complex), "complex128"),
                               ([noise, np.where(noise > 1, np.nan, noise)], "replicate 2")):
            with self.assertRaisesRegex(imunoise.Error, words):
                imunoise.from_arrays({"x": channel}, 10)
        with self.assertRaisesRegex(imunoise.Error, r"\(20, 10\) is no span"):
            imunoise.read("absent.csv", exclude=[(20, 10)])
        with self.assertRaisesRegex(imunoise.Error, r"absent.csv"):
            imunoise.read("absent.csv", channels="gyro_x")
        x = imunoise.from_arrays({"x": noise}, 10)
        with self.assertRaisesRegex(imunoise.Error, r"did you mean WN"):
            imunoise.fit(x, "ARW")
        with self.assertRaisesRegex(imunoise.Error, r"did you mean 'x1'"):
            imunoise.fit(imunoise.from_arrays({"x1": noise, "y1": noise}, 10), "WN", "x2")
        with self.assertRaisesRegex(imunoise.Error, r"did you mean 'kalibr'"):
            imunoise.export([imunoise.fit(x, "WN")], "kalbr")
        for wrong in (lambda: imunoise.fit(x, "WN", "y"), lambda: imunoise.fit(x, "WN", weights="all"),
                      lambda: imunoise.fit(x, "WN", confidence=1.5), lambda: imunoise.read(),
                      lambda: imunoise.wavelet_variance(x, per_octave=3), lambda: imunoise.read("absent.csv"),
                      lambda: imunoise.simulate("WN", 10, 100)):
            with self.assertRaises(imunoise.Error):
                wrong()
        with self.assertRaises(IndexError):
            x.samples("x", 1)

    def test_results_do_not_depend_on_threads(self):
        x = imunoise.simulate("WN(sigma2=1) + RW(gamma2=0.01)", 10, 8192, replicates=4, seed=3)
        with imunoise.limit_threads(1):
            one = imunoise.fit(x, "AR1 + WN")
        self.assertEqual(plain(one), plain(imunoise.fit(x, "AR1 + WN")))


class LongWork(unittest.TestCase):
    def test_progress_rises_to_one(self):
        told = []
        x = imunoise.simulate("WN(sigma2=1)", 100, 500_000, replicates=8, progress=told.append)
        imunoise.wavelet_variance(x, per_octave=4, robust=0.9, progress=told.append)
        self.assertEqual(told[-1], 1.0)
        self.assertTrue(all(0.0 <= one <= 1.0 for one in told))

    def test_an_exception_of_progress_stops_the_work(self):
        def refuse(_):
            raise RuntimeError("enough")
        with self.assertRaisesRegex(RuntimeError, "enough"):
            imunoise.simulate("WN(sigma2=1)", 100, 100_000, progress=refuse)

    def test_interrupts_stop_the_work(self):
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        try:
            timer = threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT))
            timer.start()
            with self.assertRaises(KeyboardInterrupt):
                while True:  # however fast the machine is
                    imunoise.simulate("WN(sigma2=1) + AR1(sigma2=1, phi=0.9)", 100, 1_000_000, replicates=50)
        finally:
            timer.join()
            signal.signal(signal.SIGINT, before)

    def test_other_threads_run_meanwhile(self):
        count, done = 0, threading.Event()
        def counting():
            nonlocal count
            while not done.is_set():
                count += 1
                time.sleep(0.001)
        other = threading.Thread(target=counting)
        during = []
        other.start()
        imunoise.simulate("WN(sigma2=1) + AR1(sigma2=1, phi=0.9)", 100, 1_000_000, replicates=10,
                          progress=lambda _: during.append(count))
        done.set()
        other.join()
        self.assertGreater(during[-1], 0)


if __name__ == "__main__":
    unittest.main()
