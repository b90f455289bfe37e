// The module _imunoise. Its functions take numbers of channels and return JSON;
// imunoise/__init__.py makes a package of them, with names of channels, dictionaries and
// documentation.

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>

#include "core/support/parallel.h"
#include "python/analyses.h"
#include "python/job.h"
#include "python/recording.h"
#include "recording/import/import.h"
#include "recording/import/pieces.h"
#include "recording/import/table/options.h"
#include "recording/store/disk/file_system.h"
#include "recording/store/reading/replicates.h"
#include "study/analysis/preflights.h"
#include "study/analysis/series.h"
#include "study/report/json.h"

namespace imunoise::python {
namespace {

namespace py = pybind11;

Recording read(const std::vector<std::filesystem::path>& files, const Words& channels, bool beside,
               std::optional<double> rate,
               const std::vector<std::pair<std::string, std::string>>& units,
               std::optional<double> time_unit, std::optional<double> from,
               std::optional<double> until, const std::vector<std::pair<double, double>>& exclude,
               bool strict, const std::string& topic, const std::string& dbc,
               std::size_t split_into, const py::object& progress) {
  recording::ImportOptions options;
  options.channels = channels;
  options.beside = beside;
  if (rate) options.rate = Hertz{*rate};
  for (const auto& [pattern, unit] : units)
    options.units.push_back({pattern, value_of(parse_unit(unit))});
  options.time_unit = time_unit;
  options.from = from;
  options.until = until;
  for (const auto& [begin, end] : exclude) options.exclude.push_back({begin, end});
  options.strict = strict;
  options.topic = topic;
  options.dbc = dbc;
  options.split_into = split_into;
  if (split_into == 0) throw Failure("split_into: expected at least 1");
  if (files.empty()) throw Failure("there are no files to read");
  const auto import = [&](const Progress& told) -> Result<std::vector<recording::Replicate>> {
    if (files.size() == 1 && std::filesystem::is_directory(files.front()) &&
        recording::pieces_of(files.front()).empty())
      return recording::import_recording(recording::posix_file_system(), files.front(), options,
                                         told);
    return recording::import_files(files, options, told);
  };
  return {run(import, progress)};
}

Words channels(const Recording& recording) {
  Words out;
  for (const recording::Channel& one : recording.replicates.front().channels)
    out.push_back(one.name);
  return out;
}

std::vector<std::string> preflight(const Recording& recording) {
  std::vector<std::string> out;
  for (const v1::Preflight& one : study::preflights(recording.replicates))
    out.push_back(report::to_json(one));
  return out;
}

py::class_<Recording> add_recording(py::module_& module) {
  py::class_<Recording> out(module, "Recording");
  out.def("channels", &channels)
      .def("channel_called",
           [](const Recording& of, const std::string& name) {
             return value_of(study::channel_called(name, of.replicates.front()));
           })
      .def("is_interpolated",
           [](const Recording& of, std::size_t c) { return of.channel(0, c).interpolated; })
      .def("unit",
           [](const Recording& of, std::size_t c) {
             return std::string(si_symbol(of.channel(0, c).unit.quantity));
           })
      .def("rate", [](const Recording& of) { return of.replicates.front().rate.value; })
      .def("names",
           [](const Recording& of) {
             Words names;
             for (const recording::Replicate& one : of.replicates) names.push_back(one.name);
             return names;
           })
      .def("sources",
           [](const Recording& of) {
             Words files;
             for (const recording::Replicate& one : of.replicates)
               files.push_back(one.source.string());
             return files;
           })
      .def("preflight", &preflight)
      .def("samples", &samples);
  return out;
}

}  // namespace

// NOLINTNEXTLINE: the macro's own names
PYBIND11_MODULE(_imunoise, module) {
  py::register_exception<Failure>(module, "Error", PyExc_ValueError);
  module.attr("version") = IMUNOISE_VERSION;
  add_recording(module);
  py::class_<Measuring>(module, "Measuring")
      .def(py::init([](int per_octave, std::optional<double> robust, double confidence) {
        return Measuring{per_octave, robust, confidence};
      }));
  py::class_<ThreadLimit>(module, "ThreadLimit").def(py::init<std::size_t>());
  module.def("read", &read);
  module.def("from_arrays", &from_arrays);
  module.def("simulated", &simulated);
  module.def("wavelet_variance", &wavelet_variance);
  module.def("deviation", &deviation);
  module.def("fit", &fit);
  module.def("diagnose", &diagnose);
  module.def("array", &array);
  module.def("study", &study);
  module.def("export_noise", [](const std::string& fits, const std::string& to, const Text& axis,
                                bool conservative, std::pair<double, double> horizon,
                                std::optional<double> step, const std::string& source) {
    return py::bytes(export_noise(fits, to, axis, conservative, horizon, step, source));
  });
}

}  // namespace imunoise::python
