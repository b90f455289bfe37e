"""Noise models of inertial sensors from static recordings.

    import imunoise

    recording = imunoise.read("run1.csv", "run2.csv", units={"gyro_*": "deg/s"})
    report = imunoise.fit(recording, "WN + AR1 + RW", channel="gyro_x")
    print(report["summary"])

Results are the JSON documents that the program `imunoise` prints with --json, as dictionaries; lists of numbers
are NumPy arrays. All numbers are in SI units. Functions that take time release the GIL, stop at Ctrl-C, and call
`progress(fraction)`, if you pass one, with the fraction done (0 … 1).
"""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _imunoise
from ._imunoise import Error

__version__: str = _imunoise.version
__all__ = ["Error", "Recording", "Study", "allan_deviation", "array", "diagnose", "export", "fit", "from_arrays",
           "hadamard_deviation", "limit_threads", "read", "simulate", "wavelet_variance"]

Progress = Callable[[float], None]
Document = dict[str, Any]
Path = str | os.PathLike[str]

_TIME_UNITS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9}


def _with_arrays(value: Any) -> Any:
    """Lists of numbers as arrays, in the whole document."""
    if isinstance(value, dict):
        return {key: _with_arrays(one) for key, one in value.items()}
    if isinstance(value, list):
        if value and all(isinstance(one, (int, float)) and not isinstance(one, bool) for one in value):
            return np.array(value, dtype=float)
        return [_with_arrays(one) for one in value]
    return value


def _json(value: Any) -> str:
    """The document as the program writes it."""
    def plain(one: Any) -> Any:
        if isinstance(one, (np.ndarray, np.generic)):
            return one.tolist()
        raise TypeError(f"{type(one).__name__} cannot be written as JSON")
    return json.dumps(value, default=plain)


class Recording:
    """Replicates of static recordings: the same channels, one rate. Made by read(), from_arrays() and simulate()."""

    def __init__(self, core: _imunoise.Recording) -> None:
        self._core = core

    def __repr__(self) -> str:
        return f"<imunoise.Recording: {len(self)} replicates of {', '.join(self.channels)} at {self.rate:g} Hz>"

    def __len__(self) -> int:
        """Number of replicates."""
        return len(self._core.names())

    @property
    def channels(self) -> list[str]:
        """Names of the channels."""
        return self._core.channels()

    @property
    def rate(self) -> float:
        """Sampling rate (Hz)."""
        return self._core.rate()

    @property
    def names(self) -> list[str]:
        """Names of the replicates."""
        return self._core.names()

    @property
    def preflight(self) -> list[Document]:
        """What imunoise recognised in each file, and its faults; empty for arrays and simulations."""
        return [_with_arrays(json.loads(one)) for one in self._core.preflight()]

    def unit(self, channel: str) -> str:
        """SI unit of a channel, such as "rad/s"; "1" if it is unknown."""
        return self._core.unit(self._core.channel_called(channel))

    def samples(self, channel: str, replicate: int = 0) -> npt.NDArray[np.float64]:
        """Samples of one replicate in SI, shape (samples,), read only. They are not copied if the file holds
        64-bit floats in SI units."""
        if not 0 <= replicate < len(self):
            raise IndexError(f"replicate {replicate}: there are {len(self)}, counted from 0")
        return self._core.samples(replicate, self._core.channel_called(channel))

    def _subjects(self, channel: str | None) -> list[int]:
        if channel is not None:
            return [self._core.channel_called(channel)]
        return [c for c in range(len(self.channels)) if not self._core.is_interpolated(c)]


def read(*files: Path, channels: Sequence[str] = (), rate: float | None = None,
         units: str | Mapping[str, str] = "", time_unit: str | None = None, start: float | None = None,
         until: float | None = None, exclude: Iterable[tuple[float, float]] = (), strict: bool = False,
         topic: str = "", dbc: str = "", split_into: int = 1, beside: bool = False,
         progress: Progress | None = None) -> Recording:
    """Reads files of any format that imunoise knows, or one folder that imunoise recorded.

    Args:
        files: each is one replicate; faults cut it into several.
        channels: names to read, in this order; wildcards are allowed. Empty: all.
        rate: sampling rate (Hz); overrides that of the files.
        units: one unit for all channels, or units by name: {"gyro_*": "deg/s", "acc_*": "g"}.
        time_unit: "s", "ms", "us" or "ns". None: recognised.
        start, until: times to use (s after the first sample of each file).
        exclude: spans to leave out, (begin, end) in s.
        strict: refuse files with faults.
        topic: topic of a bag.
        dbc: database for logs of a CAN bus, or the name of a known IMU.
        split_into: number of replicates made of each file.
        beside: with `channels`, keep all other channels too: diagnose() and Study use them as witnesses.
        progress: called with the fraction done.

    Each doubt and each fault of a file is a warning; the property `preflight` has them, too.

    Raises:
        Error: a file that cannot be read, and how to mend it.
    """
    if time_unit is not None and time_unit not in _TIME_UNITS:
        raise Error(f"time_unit: '{time_unit}' is none of {', '.join(_TIME_UNITS)}")
    spans = [(float(begin), float(end)) for begin, end in exclude]
    for begin, end in spans:
        if not begin < end:
            raise Error(f"exclude: ({begin:g}, {end:g}) is no span of time; give (begin, end) in s")
    rules = list(units.items()) if isinstance(units, Mapping) else [("*", units)] if units else []
    out = Recording(_imunoise.read([os.fspath(one) for one in files], _names(channels), beside, rate, rules,
                                   _TIME_UNITS[time_unit] if time_unit else None, start, until, spans,
                                   strict, topic, dbc, split_into, progress))
    for file in out.preflight:
        for finding in file.get("findings", []):
            warnings.warn(f"{file['file']}: {finding['text']}", stacklevel=2)
    return out


def _numbers(name: str, replicate: int, given: npt.ArrayLike) -> Any:
    if np.ma.is_masked(given):
        raise Error(f"{name}: replicate {replicate} has masked samples; cut the array there and pass its parts as "
                    "replicates")
    array = np.asarray(given)
    if array.dtype.kind not in "fiub":
        raise Error(f"{name}: replicate {replicate} has values of type {array.dtype}; samples are real numbers")
    return array.astype(float, copy=False)


def _names(given: str | Sequence[str]) -> list[str]:
    return [given] if isinstance(given, str) else list(given)


def from_arrays(channels: Mapping[str, npt.ArrayLike | Sequence[npt.ArrayLike]], rate: float,
                units: str | Mapping[str, str] = "") -> Recording:
    """Makes a recording of arrays, which are copied once.

    Args:
        channels: by name, one array of shape (samples,), or a list of such arrays, one a replicate. A
            two-dimensional array is (replicates, samples).
        rate: sampling rate (Hz).
        units: the unit of all channels, or of each by name. Without a unit, numbers stay as they are.

    Raises:
        Error: arrays of different lengths, fewer than 16 samples, values that are not finite, an unknown unit.
    """
    arrays: list[tuple[str, list[Any]]] = []
    for name, given in channels.items():
        several = isinstance(given, (list, tuple)) and len(given) > 0 and np.ndim(given[0]) == 1
        several = several or getattr(given, "ndim", 1) == 2
        arrays.append((name, [_numbers(name, r + 1, one) for r, one in enumerate(given if several else [given])]))
    if isinstance(units, Mapping):
        unknown = [name for name in units if name not in channels]
        if unknown:
            raise Error(f"units: there is no channel '{unknown[0]}'")
    texts = [units.get(name, "") if isinstance(units, Mapping) else units for name, _ in arrays]
    return Recording(_imunoise.from_arrays(arrays, texts, rate))


def simulate(model: str, rate: float, samples: int, replicates: int = 1, seed: int = 1, unit: str = "",
             channel: str = "x", progress: Progress | None = None) -> Recording:
    """Draws replicates of a model whose parameters all have values, as `imunoise simulate` does: the same seed
    gives the same numbers.

    Args:
        model: such as "WN(sigma2=2.5e-7) + RW(gamma2=5e-14)"; docs/models.md lists processes and effects.
        rate: sampling rate (Hz).
        samples: samples of each replicate.
        replicates: number of replicates.
        seed: random seed.
        unit: SI unit of the samples, such as "rad/s".
        channel: name of the channel.
    """
    return Recording(_imunoise.simulated(model, rate, samples, replicates, seed, unit, channel, progress))


def _each(recording: Recording, channel: str | None, analyse: Callable[[int], str]) -> Document:
    """The document of one channel; of several, {"channels": [...]}, as the program prints them."""
    reports = [_with_arrays(json.loads(analyse(c))) for c in recording._subjects(channel)]
    return reports[0] if len(reports) == 1 else {"channels": reports}


def wavelet_variance(recording: Recording, channel: str | None = None, *, per_octave: int = 1,
                     robust: float | None = None, confidence: float = 0.95,
                     progress: Progress | None = None) -> Document:
    """Haar wavelet variance of all replicates, as `imunoise wv --json`.

    Args:
        channel: name of the channel. None: all.
        per_octave: averaging times an octave: 1, 2 or 4.
        robust: 0.6, 0.8 or 0.9, the efficiency of the robust estimator; None: classical.
        confidence: level of the intervals.

    Returns:
        "scales_s" (averaging time of the wavelet, 2m samples, in s), "variance", "lower" and "upper" (unit²),
        each of shape (scales,), pooled; "replicates" has the same of each replicate, and "edof", degrees of freedom.
    """
    measuring = _imunoise.Measuring(per_octave, robust, confidence)
    return _each(recording, channel,
                 lambda c: _imunoise.wavelet_variance(recording._core, c, measuring, progress))


def _deviation(recording: Recording, channel: str, kind: str, confidence: float) -> Document:
    if not isinstance(channel, str):
        raise Error("channel: expected the name of one channel")
    core = recording._core
    document = json.loads(_imunoise.deviation(core, core.channel_called(channel), kind, confidence))
    points = document.pop("points")
    for name in ("tau_s", "deviation", "lower", "upper", "degrees_of_freedom"):
        document[name] = np.array([one[name] for one in points], dtype=float)
    document["noise"] = [one["noise"] for one in points]
    return document


def allan_deviation(recording: Recording, channel: str, *, confidence: float = 0.95) -> Document:
    """Overlapping Allan deviation of all replicates at the customary averaging times, as `imunoise wv --allan`.

    Returns:
        "tau_s" (s), "deviation", "lower", "upper" (unit of the channel) and "degrees_of_freedom", each of shape
        (times,); "noise", the law at each time ("WN", "RW", "QN"); "minimum", where the deviation is smallest.
    """
    return _deviation(recording, channel, "allan", confidence)


def hadamard_deviation(recording: Recording, channel: str, *, confidence: float = 0.95) -> Document:
    """The same by third differences, blind to a ramp, as `imunoise wv --hadamard`."""
    return _deviation(recording, channel, "hadamard", confidence)


def fit(recording: Recording, model: str | None = None, channel: str | None = None, *,
        estimator: str = "mugmwm", weights: str = "full", confidence: float = 0.95, per_octave: int = 1,
        robust: float | None = None, progress: Progress | None = None) -> Document:
    """Fits a noise model to all replicates, as `imunoise fit --json`.

    Args:
        model: such as "2*AR1 + WN + RW"; None: the program's default.
        channel: name of the channel. None: all.
        estimator: "mugmwm", "agmwm" or "whittle".
        weights: "full" or "diag".
        confidence: level of the intervals.

    Returns:
        "verdict" ("fits", "doubtful", "does_not_fit", "not_tested"), "p_value", "terms" with parameters and
        coefficients, "budget" with the curves, each of shape (scales,), "fitted_model", "summary" and more.
    """
    measuring = _imunoise.Measuring(per_octave, robust, confidence)
    return _each(recording, channel,
                 lambda c: _imunoise.fit(recording._core, c, model, estimator, weights, measuring, progress))


def diagnose(recording: Recording, model: str | None = None, channel: str | None = None, *,
             witnesses: Sequence[str] = (), automatic: bool = False, level: float = 0.05,
             progress: Progress | None = None) -> Document:
    """Finds the physical effect that a model lacks, as `imunoise diagnose --json`.

    Args:
        model: noise and effects; None: chosen by cross-validation.
        channel: name of the channel. None: all.
        witnesses: channels that the output may follow; empty: all others of the recording.
        automatic: add what is found, and go on.
        level: false-alarm probability over all candidates.
    """
    return _each(recording, channel, lambda c: _imunoise.diagnose(recording._core, c, model, _names(witnesses),
                                                                  automatic, level, progress))


def array(recording: Recording, model: str | None = None, channels: Sequence[str] = (), *,
          groups: Sequence[Sequence[str]] = (), scales: str = "all", rule: str = "unit-gain",
          efficient: bool = False, confidence: float = 0.95, progress: Progress | None = None) -> Document:
    """Fits one model to all sensors of an array and makes their quietest virtual sensor, as `imunoise array --json`.

    Args:
        model: such as "AR1 + WN + RW[corr]"; None: that one.
        channels: one a sensor; empty: all of the recording.
        groups: names of the sensors that share processes marked [group].
        scales: averaging times to be quiet at: "short", "long", "all" or weights separated by commas.
        rule: of the weights: "unit-gain", "nonnegative" or "unit-length".
        efficient: go on to the maximum of Whittle's likelihood.
    """
    numbers = [recording._core.channel_called(one) for one in channels] or recording._subjects(None)
    text = _imunoise.array(recording._core, numbers, model, [list(one) for one in groups], scales, rule, efficient,
                           confidence, progress)
    return _with_arrays(json.loads(text))


class Study:
    """The models tried on one channel, and what each lacks, as `imunoise study`.

    Args:
        recording: read it with beside=True, or without `channels`, so that witnesses are there.
        channel: name of the channel.
        model: the first model; None: chosen by cross-validation.
        witnesses: channels that the output may follow; empty: all others.
    """

    def __init__(self, recording: Recording, channel: str, model: str | None = None,
                 witnesses: Sequence[str] = (), *, progress: Progress | None = None) -> None:
        self._recording = recording
        self._text = ""
        files = [os.path.abspath(one) for one in dict.fromkeys(recording._core.sources()) if one]
        self._apply("open", {"input": {"files": files, "rate_hz": recording.rate}, "channel": channel,
                             "witnesses": _names(witnesses), "model": model or ""}, progress)

    def _apply(self, operation: str, content: Document, progress: Progress | None) -> Document:
        self._text = _imunoise.study(self._recording._core, self._text, json.dumps({operation: content}), progress)
        return self.document

    @property
    def document(self) -> Document:
        """The whole study, as its file holds it (proto/imunoise/v1/study.proto)."""
        return _with_arrays(json.loads(self._text))

    def candidates(self, *, progress: Progress | None = None) -> Document:
        """Seeks what the current model lacks."""
        return self._apply("candidates", {}, progress)

    def add(self, term: str, *, progress: Progress | None = None) -> Document:
        """Adds a process or an effect to the current model: "QN", "line(f=7.12)"."""
        return self._apply("add", {"term": term}, progress)

    def undo(self, *, progress: Progress | None = None) -> Document:
        """Goes back to the model that the current one was made from."""
        return self._apply("undo", {}, progress)

    def redo(self, *, progress: Progress | None = None) -> Document:
        """Goes forward again to what was undone last."""
        return self._apply("redo", {}, progress)

    def try_model(self, model: str, *, progress: Progress | None = None) -> Document:
        """Tries another model beside the current one."""
        return self._apply("try_model", {"model": model}, progress)

    def save(self, path: Path) -> None:
        """Writes the study's file, which `imunoise study` and `imunoise open` read."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self._text)


def export(fits: Document | Sequence[Document], to: str, *, axis: str | None = None, conservative: bool = False,
           horizon: tuple[float, float] = (0.1, 10.0), step: float | None = None,
           source: str = "Python") -> str | bytes:
    """The file for another program, as `imunoise export --to`: "kalibr", "px4", "kf-json", ... Bytes for "kf-numpy".

    Args:
        fits: what fit() or array() returned, or a list of fits.
        axis: "each", "worst" or "mean"; None: as the program can.
        conservative: bound the integrated error of the whole model over the horizon.
        horizon: times over which the filter relies on the sensor alone (s).
        step: step of the filter (s), for px4 and ardupilot.
        source: name of the recording, which the file states.
    """
    document = fits if isinstance(fits, Mapping) else {"channels": list(fits)}
    file = _imunoise.export_noise(_json(document), to, axis, conservative, horizon, step, source)
    return file if file.startswith(b"PK") else file.decode()  # PK: an archive


class limit_threads:
    """Context in which imunoise uses at most `count` threads. Results do not depend on it."""

    def __init__(self, count: int) -> None:
        if count < 1:
            raise Error("limit_threads: expected at least 1")
        self._count = count
        self._limit: Any = None

    def __enter__(self) -> "limit_threads":
        self._limit = _imunoise.ThreadLimit(self._count)
        return self

    def __exit__(self, *_: object) -> None:
        self._limit = None
