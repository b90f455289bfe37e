#include <fmt/format.h>

#include <memory>

#include "cli/parse/commands.h"
#include "cli/parse/input_options.h"
#include "drivers/can/presets.h"
#include "drivers/emulator/effect_catalogue.h"
#include "drivers/emulator/fault_text.h"

namespace imunoise::cli {
namespace {

constexpr const char* kEmulateHelp = R"help(
Examples:
  imunoise emulate --device xsens --seed 7               an MTi-G-710 on a pseudo-terminal
  imunoise emulate --device can --model "gyro: WN(sigma2=1e-6) + RW(gamma2=1e-12)" --rate 200
  imunoise emulate --device can --at vcan0 --effect "fan(frequency=23, amplitude=1e-3, channel=gyro_x)"
  imunoise record trial --device "emulated device=adis16405 seed=7" --duration 10

The first lines that it prints say how to record the device; it runs until Ctrl-C. An ADIS16405 is on USB, which
only a kernel can serve: it is emulated inside imunoise record, as in the last example (so can the others be).
Times are in s, temperatures in K, amplitudes in the SI unit of the channel; without channel= an effect
acts on all three gyroscopes.
)help";

std::string lines(const std::string& title, const std::vector<std::string>& all) {
  std::string out = "\n" + title + "\n";
  for (const std::string& line : all) out += "  " + line + "\n";
  return out;
}

ParsedCommand emulate_command(CLI::App& program) {
  struct Raw {
    emulator::ServePlan plan{.driver = {}, .place = {}, .source = {}};
    double rate = 100.0;
    double duration = 0.0;
    std::string generation = "mti-g-710";
  };
  CLI::App* const emulate =
      program.add_subcommand("emulate", "Serve an inertial sensor that is not there");
  emulate->footer(kEmulateHelp + lines("Effects:", emulator::describe_effects()) +
                  lines("Faults (samples are counted from 0):", emulator::describe_faults()));
  const auto raw = std::make_shared<Raw>();
  emulator::ServePlan& plan = raw->plan;
  emulate->add_option("--device", plan.driver, "Whose driver shall find it: xsens or can")
      ->required()
      ->check(CLI::IsMember({"xsens", "can", "adis16405"}));
  emulate->add_option("--at", plan.place,
                      "xsens: path of a link to the pseudo-terminal (default: imunoise-mti in the "
                      "temporary folder); can: an interface (vcan0) or unix:PATH (default: unix: "
                      "and imunoise-can there)");
  emulate
      ->add_option("--model", plan.source.models,
                   "Noise, as \"gyro: WN(sigma2=1e-6)\", per sample in SI; repeatable")
      ->allow_extra_args(false);
  emulate->add_option("--effect", plan.source.effects, "See below; repeatable")
      ->allow_extra_args(false);
  emulate->add_option("--fault", plan.faults, "See below; repeatable")->allow_extra_args(false);
  emulate->add_option("--seed", plan.source.seed, "Of all random numbers")->capture_default_str();
  emulate
      ->add_option("--rate", raw->rate,
                   "Samples a second; an MTi's is the driver's choice, and this is what its model "
                   "is read at")
      ->check(CLI::Range(0.1, 10'000.0))
      ->capture_default_str();
  emulate->add_option("--preset", plan.preset, "can: which IMU: mti600, aceinna, mm5.10")
      ->capture_default_str();
  emulate->add_option("--generation", raw->generation, "xsens: mti-g-710, or mti-g")
      ->check(CLI::IsMember({"mti-g-710", "mti-g"}))
      ->capture_default_str();
  emulate->add_option("--duration", raw->duration, "s; without it, until Ctrl-C")
      ->check(above_zero());
  return {emulate, [raw] {
            EmulateArguments out{raw->plan, {}};
            out.plan.source.rate = Hertz{raw->rate};
            out.plan.fourth_generation = raw->generation == "mti-g-710";
            if (out.plan.place.empty()) {
              const auto temporary = std::filesystem::temp_directory_path();
              out.plan.place = out.plan.driver == "can"
                                   ? "unix:" + (temporary / "imunoise-can").string()
                                   : (temporary / "imunoise-mti").string();
            }
            if (raw->duration > 0.0) out.duration = std::chrono::duration<double>(raw->duration);
            return out;
          }};
}

}  // namespace

std::vector<ParsedCommand> emulation_commands(CLI::App& program) {
  return {emulate_command(program)};
}

}  // namespace imunoise::cli
