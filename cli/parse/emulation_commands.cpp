#include <fmt/format.h>

#include <memory>

#include "cli/parse/commands.h"
#include "cli/parse/input_options.h"
#include "drivers/can/codec/presets.h"
#include "drivers/emulator/effects/effect_catalogue.h"
#include "drivers/emulator/faults/fault_text.h"

namespace imunoise::cli {
namespace {

constexpr const char* kEmulateHelp = R"help(
Examples:
  imunoise emulate --device xsens --seed 7               an MTi-G-710 on a pseudo-terminal
  imunoise emulate --device can --model "gyro: WN(sigma2=1e-6) + RW(gamma2=1e-12)" --rate 200
  imunoise emulate --device can --at vcan0 --effect "fan(frequency=23, amplitude=1e-3, channel=gyro_x)"
  imunoise record trial --device "emulated device=adis16405 seed=7" --duration 10

imunoise prints the command that records the device, then runs until Ctrl-C. Only the kernel can offer a USB
device, so the ADIS16405 runs inside imunoise record, as in the last example. The other devices can, too.
Units: s, K, and the SI unit of the channel for amplitudes. Without channel=, an effect acts on all three
gyroscopes.
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
  CLI::App* const emulate = program.add_subcommand("emulate", "Emulate an inertial sensor");
  emulate->footer(kEmulateHelp + lines("Effects:", emulator::describe_effects()) +
                  lines("Faults (sample numbers start at 0):", emulator::describe_faults()));
  const auto raw = std::make_shared<Raw>();
  emulator::ServePlan& plan = raw->plan;
  emulate->add_option("--device", plan.driver, "Device to emulate")
      ->required()
      ->check(CLI::IsMember({"xsens", "can", "adis16405"}));
  emulate
      ->add_option(
          "--at", plan.place,
          "Where the device appears: for xsens the path of a link to the pseudo-terminal; for "
          "can an interface such as vcan0, or unix:PATH")
      ->type_name("PLACE")
      ->default_str("/tmp/imunoise-mti; unix:/tmp/imunoise-can");
  emulate
      ->add_option("--model", plan.source.models,
                   "Noise to add, such as \"gyro: WN(sigma2=1e-6)\" (per sample, SI)")
      ->type_name("MODEL")
      ->allow_extra_args(false);
  emulate
      ->add_option("--effect", plan.source.effects,
                   "Effect to add, such as \"fan(frequency=23, amplitude=1e-3)\"; listed below")
      ->type_name("EFFECT")
      ->allow_extra_args(false);
  emulate
      ->add_option("--fault", plan.faults,
                   "Fault to inject, such as \"loss(sample=500)\"; listed below")
      ->type_name("FAULT")
      ->allow_extra_args(false);
  emulate->add_option("--seed", plan.source.seed, "Random seed")
      ->type_name("SEED")
      ->capture_default_str();
  emulate
      ->add_option("--rate", raw->rate,
                   "Sampling rate (Hz); for xsens the driver sets the rate, and this one only "
                   "converts the model")
      ->type_name("HZ")
      ->check(CLI::Range(0.1, 10'000.0))
      ->capture_default_str();
  emulate->add_option("--preset", plan.preset, "can: IMU to emulate: mti600, aceinna or mm5.10")
      ->type_name("IMU")
      ->capture_default_str();
  emulate->add_option("--generation", raw->generation, "xsens: generation of the device")
      ->check(CLI::IsMember({"mti-g-710", "mti-g"}))
      ->capture_default_str();
  emulate->add_option("--duration", raw->duration, "Time to run (s)")
      ->type_name("SECONDS")
      ->default_str("until Ctrl-C")
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
