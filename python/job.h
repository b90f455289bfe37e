#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <thread>
#include <utility>

#include "core/support/progress.h"
#include "core/support/result.h"

namespace imunoise::python {

/// What Python sees as imunoise.Error.
class Failure : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

template <class T>
T value_of(Result<T> result) {
  if (!result) throw Failure(result.error().message);
  return std::move(*result);
}

/// Runs `work(const Progress&)`, which returns a Result, in a thread of its own without the GIL.
/// Meanwhile this thread calls `progress` (None, or a function of the fraction done) whenever the
/// fraction has changed, and answers signals: what `progress` or a signal's handler raises
/// (KeyboardInterrupt) asks the work to stop, and is raised once it has. Precondition: the GIL is
/// held.
template <class Work>
auto run(const Work& work, const pybind11::object& progress) {
  constexpr std::chrono::milliseconds kPatience{50};
  std::mutex mutex;
  std::condition_variable changed;
  bool done = false;
  std::atomic<double> fraction = 0.0;
  std::exception_ptr thrown;
  std::optional<decltype(work(Progress()))> out;
  std::jthread worker([&](const std::stop_token& stop) {
    try {
      out.emplace(work(Progress([&](double now) { fraction = now; }, stop)));
    } catch (...) {
      thrown = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    done = true;
    changed.notify_one();
  });
  const auto wait = [&] {
    const pybind11::gil_scoped_release released;
    std::unique_lock lock(mutex);
    return changed.wait_for(lock, kPatience, [&] { return done; });
  };
  try {
    for (double told = 0.0; !wait();) {
      if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
      const double now = fraction;
      if (!progress.is_none() && now > told) progress(told = now);
    }
    if (!progress.is_none()) progress(1.0);
  } catch (...) {
    worker.request_stop();
    const pybind11::gil_scoped_release released;
    worker.join();
    throw;
  }
  worker.join();
  if (thrown) std::rethrow_exception(thrown);
  return value_of(std::move(*out));
}

}  // namespace imunoise::python
