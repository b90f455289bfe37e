// Files with odd times.

#include "tests/recording/files.h"
#include "tests/recording/odd/odd_files.h"

namespace imunoise::recording::odd {

std::vector<OddFile> odd_times() {
  OddFiles list;
  list.good("times in s", "100 Hz", odd_table("t,x\n", [](int i) { return t(i) + "," + x(i); }),
            "seconds");
  list.good("times in ms", "100 Hz, milliseconds by their steps",
            odd_table("t,x\n", [](int i) { return fmt::format("{},{}", 10 * i, x(i)); }),
            "milliseconds");
  list.good("times in µs", "100 Hz, microseconds",
            odd_table("t_us,x\n", [](int i) { return fmt::format("{},{}", 10'000 * i, x(i)); }),
            "microseconds");
  list.good("times in ns", "100 Hz, nanoseconds",
            odd_table("t,x\n", [](int i) { return fmt::format("{},{}", 10'000'000LL * i, x(i)); }),
            "nanoseconds");
  list.good(
      "seconds since 1970 with fractions", "100 Hz",
      odd_table("time,x\n", [](int i) { return fmt::format("{:.2f},{}", 1.7e9 + 0.01 * i, x(i)); }),
      "seconds since 1970");
  list.good("nanoseconds since 1970", "100 Hz, no digit is lost",
            odd_table("timestamp,x\n",
                      [](int i) {
                        return fmt::format("{},{}", 1'700'000'000'123'456'789LL + 10'000'000LL * i,
                                           x(i));
                      }),
            "nanoseconds since 1970");
  list.good("ISO dates and times", "100 Hz",
            odd_table("time,x\n",
                      [](int i) {
                        return fmt::format("2026-11-24T12:00:{:02}.{:02}Z,{}", i / 100, i % 100,
                                           x(i));
                      }),
            "dates and times");
  list.good("dates as 24.11.2026", "100 Hz",
            odd_table("time,x\n",
                      [](int i) {
                        return fmt::format("24.11.2026 23:59:{:02}.{:02},{}", 56 + i / 100, i % 100,
                                           x(i));
                      }),
            "dates and times");
  list.good("dates as 11/24/2026", "100 Hz",
            odd_table("time,x\n",
                      [](int i) {
                        return fmt::format("11/24/2026 23:59:{:02}.{:02},{}", 56 + i / 100, i % 100,
                                           x(i));
                      }),
            "dates and times");
  list.good("times in minutes", "100 Hz",
            odd_table("Time [min],x\n",
                      [](int i) { return fmt::format("{:.9f},{}", 0.01 / 60.0 * i, x(i)); }),
            "minutes");
  list.good("ticks of .NET, 100 ns since the year 1", "100 Hz",
            odd_table("time,x\n",
                      [](int i) {
                        return fmt::format("{},{}", 638'000'000'000'000'000LL + 100'000LL * i,
                                           x(i));
                      }),
            "units of 100 ns");
  list.good("times of day that pass midnight", "100 Hz, one stretch",
            odd_table("time,x\n",
                      [](int i) {
                        return fmt::format("{}:{:02}.{:02},{}", i < 200 ? "23:59" : "00:00",
                                           (58 + i / 100) % 60, i % 100, x(i));
                      }),
            "dates and times");
  list.good("seconds and nanoseconds in two columns", "100 Hz, no digit is lost",
            odd_table("header.stamp.sec,header.stamp.nanosec,x\n",
                      [](int i) {
                        return fmt::format("{},{},{}", 1'700'000'000 + i / 100,
                                           i % 100 * 10'000'000, x(i));
                      }),
            "header.stamp.sec and header.stamp.nanosec, nanoseconds");
  list.good("columns `nsec` and `sec`", "100 Hz, no digit is lost",
            odd_table("nsec,sec,x\n",
                      [](int i) {
                        return fmt::format("{},{},{}", i % 100 * 10'000'000,
                                           1'700'000'000 + i / 100, x(i));
                      }),
            "sec and nsec, nanoseconds");
  list.good("dates with AM and PM, as 1/5/2026 11:59:58 AM", "100 Hz",
            odd_table("time,x\n",
                      [](int i) {
                        const int s = 58 + i / 100;
                        const char* const when = s < 60 ? "1/5/2026 11:59" : "1/5/2026 12:00";
                        return fmt::format("{}:{:02}.{:02} {},{}", when, s % 60, i % 100,
                                           s < 60 ? "AM" : "PM", x(i));
                      }),
            "dates and times");
  list.good("a first column that rises steadily, whatever its name", "it is the time",
            odd_table("Zeit,x\n", [](int i) { return t(i) + "," + x(i); }), "Zeit rises steadily");
  list.good("`millis()` of Arduino", "100 Hz",
            odd_table("millis,x\n", [](int i) { return fmt::format("{},{}", 10 * i, x(i)); }),
            "milliseconds");
  list.good("one late stamp", "all rows",
            odd_table("t [s],x\n",
                      [](int i) {
                        return fmt::format("{:.3f},{}", 0.01 * i + (i == 200 ? 0.03 : 0), x(i));
                      }),
            "100 Hz");
  list.good("stamps in bursts of 8", "all rows, with a warning of the jitter",
            odd_table("t [s],x\n",
                      [](int i) { return fmt::format("{:.2f},{}", 0.01 * (i / 8 * 8), x(i)); }),
            "bursts");
  list.good("coarse stamps (10 ms at 400 Hz)", "400 Hz, with a warning of the jitter",
            odd_table("t [ms],x\n",
                      [](int i) { return fmt::format("{},{}", i * 5 / 20 * 10, x(i)); }),
            "jitter")
      .rate = 400.0;
  {
    OddFile& one = list.good(
        "a gap of 0.5 s", "two stretches",
        odd_table(
            "t [s],x\n",
            [](int i) { return fmt::format("{:.2f},{}", 0.01 * i + (i >= 200 ? 0.5 : 0), x(i)); }),
        "gap of 0.5 s at 1.99 s");
    one.stretches = 2;
  }
  {
    OddFile& one = list.good("time that starts again (two files in one)", "two stretches",
                             odd_table("t [s],x\n", [](int i) { return t(i % 200) + "," + x(i); }),
                             "goes backwards by 2 s");
    one.stretches = 2;
  }
  {
    OddFile& one = list.good("rows that repeat the row before", "left out",
                             odd_table("t [s],x\n",
                                       [](int i) {
                                         const int k = i > 250 ? i - 1 : i;
                                         return t(k) + "," + x(k);
                                       }),
                             "1 rows repeat the row before");
    one.used = kOddRows - 1;
  }
  list.refused("times that never rise", "refused: `--rate`",
               odd_table("t,x\n", [](int i) { return "5," + x(i); }), "do not rise");
  {
    OddFile& one =
        list.refused("no time, no rate", "refused: `--rate`",
                     odd_table("x,y\n", [](int i) { return x(i) + "," + x(i + 1); }), "--rate HZ");
    static_cast<void>(one);
  }
  {
    OddFile& one =
        list.good("numbers without a header, with `--rate 100`", "channels `col1`, `col2`",
                  odd_table("", [](int i) { return x(i) + "," + x(i + 1); }), "");
    one.options = at_rate(100.0);
    one.channels = 2;
  }

  return list.all;
}

}  // namespace imunoise::recording::odd
