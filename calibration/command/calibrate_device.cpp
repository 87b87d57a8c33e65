#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <streambuf>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "calibration/command/device_declaration.hpp"
#include "calibration/command/devices_here.hpp"
#include "calibration/command/interrupt.hpp"
#include "calibration/command/trusted_here.hpp"
#include "calibration/device/ask_for_forces.hpp"
#include "calibration/device/calibration_json.hpp"
#include "calibration/device/device_calibration.hpp"
#include "calibration/device/edit_declaration.hpp"
#include "calibration/device/force_table.hpp"
#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/text/json_text.hpp"
#include "compiler/text/readable.hpp"
#include "compiler/text/resolver.hpp"
#include "compiler/text/standard_output.hpp"
#include "runtime/device/open_device.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

struct CalibrateDeviceOptions {
  std::string device, table, readings, out, transport;
  bool yes = false, json = false;
  std::vector<std::string> trusted;
  std::optional<double> max_force, hold;
  std::optional<std::uint64_t> seed;
};

constexpr double usual_hold = 4;         // s, for which a push is held so that a gauge can be read
constexpr double share_to_shake = 0.25;  // of the device's force
constexpr double rest_seconds = 2;

/// The device that is measured, and the declaration that its figures go into.
struct DeviceToMeasure {
  DeclaredDevice declared;
  bool is_real = false;                ///< otherwise nothing measured on it is trusted
  std::string file;                    ///< that declares it; empty: shipped, or of the current folder
  std::optional<ChosenDevice> chosen;  ///< a plugged device that can be opened
  std::optional<Connections> connections;
};

Error bad_choice(std::string sentence, std::string mend, const std::string& text) {
  return Error{Code::malformed_value, std::move(sentence), std::move(mend), {.name = "--device", .text = text}};
}

/// A declaration of a real device, by its name: readings in a table need no plugged device.
const TrustedDevice* declared_real(const std::string& name, const std::vector<TrustedDevice>& trusted) {
  const auto found =
      std::ranges::find_if(trusted, [&](const TrustedDevice& each) { return each.profile().name == name; });
  return found != trusted.end() && !found->wiring().usb.empty() ? &*found : nullptr;
}

Result<DeviceToMeasure> device_to_measure(const CalibrateDeviceOptions& options) {
  const auto trusted = trusted_here(options.trusted);
  if (!trusted) return trusted.error();
  if (trusted->owners_problem) return *trusted->owners_problem;
  warn_of_unused(*trusted);
  const std::string asked = options.device == "simulated" ? std::string("simulated:") + default_device : options.device;
  if (auto hidden = private_device(asked, trusted->checked, "--device")) return *std::move(hidden);
  DeviceToMeasure device;
  if (const TrustedDevice* named = options.table.empty() ? nullptr : declared_real(asked, trusted->devices)) {
    device.declared = named->declared();
    device.is_real = true;
    device.file = named->file();
    return device;
  }
  const std::vector<DeclaredDevice> known = devices_here({}, trusted->files);
  std::vector<PluggedIn> plugged;
  if (!asked.starts_with("simulated")) {
    device.connections = Connections::open();
    plugged = plugged_in(*device.connections, asked);
  }
  auto chosen = choose_device({.spelling = asked.empty() ? "auto" : asked, .transport = options.transport}, known,
                              trusted->devices, plugged);
  if (!chosen) return std::move(chosen.error());
  if (!chosen->declared)
    return Error{Code::absent_device, "no force-feedback device is plugged in",
                 "plug one in, or name a simulated one: `--device simulated:sandpaper`"};
  device.declared = *chosen->declared;
  if (device.declared.profile.shaker)
    return bad_choice(fmt::format("`{}` vibrates: it has no force to measure", device.declared.profile.name),
                      "name a joystick that pushes", options.device);
  if (!chosen->plugged) return device;
  device.is_real = chosen->plugged->driver->is_felt;
  device.file = chosen->trusted ? chosen->trusted->file() : "";
  if (!device.is_real && options.table.empty())
    return bad_choice("the pointer draws its forces, and no gauge can measure them", "name another device",
                      options.device);
  device.chosen = *std::move(chosen);
  return device;
}

Result<GaugeReadings> readings_of_table(const std::string& path, double peak) {
  constexpr std::size_t largest_table = std::size_t{16} << 20;  // a hundred thousand readings
  auto file = read_file(path, largest_table);
  if (!file) return std::move(file).error();
  return read_force_table(path, std::move(file->bytes), peak);
}

/// What was measured, with the readings that a table may keep.
struct Measured {
  DeviceCalibration calibration;
  GaugeReadings forces;
};

/// How far the forces of a shaking may all be off, as a standard error over their mean size: what the noise of the
/// readings leaves open in the responses of both ways. Mass, damping and friction are off by as much.
double error_of_forces(const DeviceCalibration& calibration, std::size_t axis, const std::vector<HandleTick>& ticks) {
  constexpr double parameters = 6;  // of a response
  double squares = 0, sizes = 0;
  for (const std::size_t way : {2 * axis, 2 * axis + 1})
    if (const auto& fit = calibration.ways[way])
      squares += fit->deviation * fit->deviation * parameters / static_cast<double>(fit->readings);
  for (const HandleTick& tick : ticks) sizes += std::abs(tick.force) / static_cast<double>(ticks.size());
  return sizes > 0 ? std::sqrt(squares) / 2 / sizes : 0;
}

/// Shakes the handle along both axes, by the responses that were just fitted.
Result<> measure_handle(Bench& bench, const DeclaredDevice& declared, double most, DeviceCalibration& into) {
  const auto noise = bench.rest(rest_seconds);
  if (!noise) return noise.error();
  into.noise = *noise;
  const DeclaredDevice so_far = calibrated(declared, into);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto ticks =
        bench.shake(static_cast<int>(axis), std::min(most, share_to_shake * bench.profile().force_newton),
                    so_far.wiring.response_of(axis, bench.profile().force_newton));
    if (!ticks) return ticks.error();
    auto fit = fit_handle(*ticks, 1 / bench.profile().rate);
    if (!fit) {
      into.handle_problem[axis] = fit.error().sentence + "; " + fit.error().mend;
      continue;
    }
    const double relative = error_of_forces(into, axis, *ticks);
    for (auto* figure : {&fit->mass, &fit->damping, &fit->friction})
      figure->error = std::hypot(figure->error, relative * figure->value);
    into.handle[axis] = *fit;
  }
  into.smallest_steps = bench.smallest_steps();
  return {};
}

Result<Measured> measure_simulated(const CalibrateDeviceOptions& options, const DeclaredDevice& declared,
                                   const std::atomic<bool>& stop) {
  PlantedDevice device(declared.profile, declared.wiring, options.seed.value_or(1));
  Bench bench(device, {1, 1}, true, stop);
  const double most = std::min(declared.profile.force_newton, options.max_force.value_or(HUGE_VAL));
  Measured measured;
  measured.forces.is_simulated = true;
  for (const GaugeStep& step : force_steps(most)) {
    const auto command = bench.push(step.way, step.command, 0.1);
    if (!command) return command.error();
    measured.forces.readings.push_back({step.way, *command, device.gauge(step.way, *command), step.repeat, 0});
  }
  auto fitted = fit_readings(measured.forces.readings, declared.profile.force_newton);
  if (!fitted) return std::move(fitted.error());
  measured.calibration = *std::move(fitted);
  // No gauge holds the simulated handle, so the pushes have left it at the edge: it is put back into the middle.
  PlantedDevice centred(declared.profile, declared.wiring, options.seed.value_or(1));
  Bench shaking(centred, {1, 1}, true, stop);
  if (auto shaken = measure_handle(shaking, declared, most, measured.calibration); !shaken) return shaken.error();
  return measured;
}

/// Standard input, with ticks without force for the device until a line is there: a device that nobody serves counts as
/// hanging. The input ends when the device is lost or the person stops.
class ServedInput final : public std::streambuf {
 public:
  explicit ServedInput(Bench& bench) : bench_(bench) {}

 protected:
  int_type underflow() override {
    pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    for (;;) {
      const int ready = poll(&input, 1, 0);
      if (ready > 0) break;
      if (ready < 0 && errno != EINTR) return traits_type::eof();
      constexpr double a_moment = 0.01;  // s
      if (!bench_.rest(a_moment)) return traits_type::eof();
    }
    const ssize_t read = ::read(STDIN_FILENO, buffer_.data(), buffer_.size());
    if (read <= 0) return traits_type::eof();
    setg(buffer_.data(), buffer_.data(), buffer_.data() + read);
    return traits_type::to_int_type(buffer_[0]);
  }

 private:
  Bench& bench_;
  std::array<char, 1> buffer_{};  // the questions after this one are read from standard input itself
};

Result<Measured> measure_plugged(const CalibrateDeviceOptions& options, DeviceToMeasure& device,
                                 const std::atomic<bool>& stop) {
  ChosenDevice chosen = *device.chosen;
  chosen.trusted = chosen.trusted->uncorrected();
  const auto say = [](std::string_view what) { print_error("{}\n", what); };
  const auto opened = open_device(*device.connections, chosen,
                                  {.priority = usual_priority - 1,
                                   .ask = say,
                                   .stop = &stop,
                                   .transport = options.transport,
                                   .most_newton = options.max_force.value_or(HUGE_VAL)});
  if (!opened) return opened.error();
  const DeviceProfile& profile = device.declared.profile;
  const auto& gain = chosen.trusted->wiring().gain;
  Bench bench(**opened, gain, false, stop);
  const double most =
      std::min(profile.force_newton, options.max_force.value_or(HUGE_VAL)) / std::max({1.0, gain[0], gain[1]});
  print_error("measuring {}, as {}; Ctrl-C ends it at once, and nothing is written then\n", in_words(*chosen.plugged),
              profile.name);
  const double hold = options.hold.value_or(usual_hold);
  Measured measured;
  ServedInput served(bench);
  std::istream typed(&served);
  auto asked = ask_for_forces(force_steps(most), typed, std::cerr, [&](const GaugeStep& step) -> Result<double> {
    auto command = bench.push(step.way, step.command, hold);
    if (!command || !(profile.continuous_newton > 0) || !(step.command > profile.continuous_newton)) return command;
    // The motor cools down until its mean heat is what it bears for long.
    constexpr double longest_rest = 60;
    const double heat = step.command / profile.continuous_newton;
    if (const auto rested = bench.rest(std::min(longest_rest, hold * (heat * heat - 1))); !rested)
      return rested.error();
    return command;
  });
  if (!asked) return std::move(asked.error());
  measured.forces = *std::move(asked);
  auto fitted = fit_readings(measured.forces.readings, profile.force_newton);
  if (!fitted) return std::move(fitted.error());
  measured.calibration = *std::move(fitted);
  print_error(
      "\nput the handle into the middle, and take the gauge and your hand off: it is shaken for twenty seconds. Enter "
      "goes on, n leaves it out: ");
  std::string answer;
  if (!std::getline(typed, answer) || answer == "n") return measured;
  if (auto shaken = measure_handle(bench, device.declared, options.max_force.value_or(HUGE_VAL), measured.calibration);
      !shaken)
    return shaken.error();
  return measured;
}

Result<Measured> measure(const CalibrateDeviceOptions& options, DeviceToMeasure& device,
                         const std::atomic<bool>& stop) {
  const double peak = device.declared.profile.force_newton;
  if (options.table.empty())
    return device.is_real ? measure_plugged(options, device, stop) : measure_simulated(options, device.declared, stop);
  auto table = readings_of_table(options.table, peak);
  if (!table) return std::move(table.error());
  auto fitted = fit_readings(table->readings, peak);
  if (!fitted) {
    fitted.error().place.name = options.table;
    return std::move(fitted.error());
  }
  return Measured{*std::move(fitted), *std::move(table)};
}

/// The person's word, typed out; nobody's word is no word.
bool says_yes(std::string_view question) {
  print_error("{} [yes/N] ", question);
  std::string answer;
  if (!std::getline(std::cin, answer)) print_error("\n");
  return answer == "yes" || answer == "y";
}

/// Asks about each gain that is far from the declared one. Error: W0802 where nobody confirms it.
Result<> confirm_gains(const DeclaredDevice& declared, const DeviceCalibration& calibration) {
  for (const GainQuestion& question : gain_questions(declared, calibration)) {
    print_error("{}\n", question.text());
    if (!says_yes("is that what the gauge showed?"))
      return Error{
          .code = Code::not_measured,
          .sentence = question.text(),
          .mend = "check the units of the readings; if they are right, answer yes (`--yes` does not answer this)"};
  }
  return {};
}

/// The declaration of a person's own device, by that of its kind.
DeclaredDevice own_device(DeclaredDevice declared, const DeviceToMeasure& device) {
  declared.wiring.is_generic = false;
  if (device.chosen && device.chosen->plugged)
    if (const auto numbers = read_usb_numbers(device.chosen->plugged->numbers)) declared.wiring.usb = {*numbers};
  if (!declared.profile.name.starts_with("my_")) declared.profile.name = "my_" + declared.profile.name;
  return declared;
}

/// The keys that a calibration replaces.
const std::vector<std::string> response_keys{"gain", "dead_band", "nonlinearity", "saturation", "offset"};

/// Whether the text declares the device with this response: what was written is read back before it counts.
Result<> reads_back(const std::string& name, const std::string& text, const DeclaredDevice& device) {
  const auto checked = check_device_file({.name = name, .bytes = text});
  if (!checked) return checked.error();
  for (const DeviceFile::Device& each : checked->exported)
    if (each.declared.profile.name == device.profile.name) {
      const DeviceWiring& wiring = each.declared.wiring;
      const double peak = device.profile.force_newton;
      for (std::size_t axis = 0; axis < 2; ++axis)
        for (const double share : {-1.0, -0.3, 0.3, 1.0}) {
          const double wanted = device.wiring.response_of(axis, peak).force(share * peak);
          if (std::abs(wiring.response_of(axis, peak).force(share * peak) - wanted) > 1e-4 * peak)
            return Error{.code = Code::damaged_file,
                         .sentence = "the new text would not say what was measured",
                         .place = {.name = name}};
        }
      return {};
    }
  return Error{
      .code = Code::unknown_device, .sentence = "the new text would not export the device", .place = {.name = name}};
}

/// The owner's file with the device in it: edited where the file declares it, added where it does not.
Result<std::string> owners_text(const std::string& file, const DeviceToMeasure& device, const DeclaredDevice& own,
                                const std::vector<std::string>& comments) {
  namespace fs = std::filesystem;
  std::error_code problem;
  const bool is_there = fs::exists(file, problem);
  if (is_there && device.file == file) {
    std::vector<std::string> also = response_keys;
    const auto bytes = read_file(file);
    if (!bytes) return bytes.error();
    auto edited = with_settings(bytes->bytes, own.profile.name, calibrated_settings(own), also);
    if (!edited) edited.error().place.name = file;
    return edited;
  }
  std::string text = device_declaration(own, comments);
  if (!is_there) return text;
  const auto known = trusted_declarations({}, file);
  if (!known) return known.error();
  if (known->owners_problem) return *known->owners_problem;
  for (const TrustedDevice& each : known->devices)
    if (each.file() == file && each.profile().name == own.profile.name)
      return Error{Code::declared_twice,
                   fmt::format("it declares `{}` already", own.profile.name),
                   "measure that one: `--device " + own.profile.name + "`",
                   {.name = file}};
  constexpr std::string_view header = "wale 1\n";  // the file has one
  return known->files.front().bytes + text.substr(header.size());
}

/// Shows the declaration, or as JSON what was found with it.
void show(const CalibrateDeviceOptions& options, nlohmann::ordered_json& found, const std::string& declaration) {
  if (!options.json) return print_out(declaration);
  found["declaration"] = declaration;
  print_out(json_lines(found));
}

/// Writes a simulation's figures where they were asked for, and nowhere else.
int write_simulated(const CalibrateDeviceOptions& options, DeclaredDevice device, nlohmann::ordered_json& found) {
  device.wiring.usb.clear();
  device.wiring.is_generic = false;
  if (!device.profile.name.starts_with("simulated_")) device.profile.name = "simulated_" + device.profile.name;
  const std::string text = device_declaration(
      device, {"`wale calibrate device` measured this on a simulation: it says nothing about a real device."},
      {"grade simulated"});
  print_error("measured on a simulation: nothing of it enters your trusted file\n");
  if (options.json || options.out.empty()) show(options, found, text);
  if (options.out.empty()) return done;
  if (const auto written = write_file(options.out, text, {options.table}); !written) return refuse(written.error());
  if (options.out != "-") print_error("{} has the declaration, of the grade simulated\n", visible_text(options.out));
  return done;
}

int write_measured(const CalibrateDeviceOptions& options, const DeviceToMeasure& device,
                   const DeclaredDevice& measured, nlohmann::ordered_json& found) {
  const bool is_owners = !device.file.empty();
  const DeclaredDevice own = is_owners ? measured : own_device(measured, device);
  const std::vector<std::string> comments{"measured by `wale calibrate device`; its other figures are those of " +
                                          device.declared.profile.name + "."};
  if (!options.out.empty()) {
    const std::string text = device_declaration(own, comments);
    if (auto same = reads_back(options.out, text, own); !same) return refuse(same.error());
    if (options.json) show(options, found, text);
    if (const auto written = write_file(options.out, text, {options.table}); !written) return refuse(written.error());
    if (options.out != "-")
      print_error("{} has the declaration; name it with --devices, or save it in {}\n", visible_text(options.out),
                  visible_text(owners_file()));
    return done;
  }
  const std::string file = owners_file();
  if (file.empty())
    return refuse(Error{Code::unwritable_file, "there is no folder for your trusted file",
                        "set HOME, or XDG_CONFIG_HOME to a whole path, or name a file with -o"});
  if (is_owners && device.file != file)
    return refuse(Error{Code::malformed_value,
                        fmt::format("`{}` is declared by {}", own.profile.name, device.file),
                        "write the measured declaration with -o FILE",
                        {.name = "--devices"}});
  const auto text = owners_text(file, device, own, comments);
  if (!text) return refuse(text.error());
  if (auto same = reads_back(file, *text, own); !same) return refuse(same.error());
  show(options, found, device_declaration(own, comments));
  finish_standard_output();  // before the question
  if (!options.yes && !says_yes(fmt::format("write this into {}?", visible_text(file)))) {
    print_error("nothing was written\n");
    return refused;
  }
  std::error_code problem;
  std::filesystem::create_directories(std::filesystem::path(file).parent_path(), problem);
  if (const auto written = write_file(file, *text, {options.table}); !written) return refuse(written.error());
  print_error("written to {}: your device is driven by it from now on\n", visible_text(file));
  return done;
}

int calibrate_device(const CalibrateDeviceOptions& options) {
  if (options.json && options.out == "-")
    return refuse(Error{Code::malformed_value,
                        "both would be written to standard output",
                        "name a file with -o; the JSON has the declaration too",
                        {.name = "--json", .text = "-o -"}});
  const std::atomic<bool>& stop = stop_on_signals();
  auto device = device_to_measure(options);
  if (!device) return refuse(device.error());
  const auto measured = measure(options, *device, stop);
  if (!measured) return refuse(measured.error());
  print_error(calibration_text(measured->calibration, device->declared.profile));
  const bool is_trusted = device->is_real && !measured->forces.is_simulated;
  if (!options.readings.empty())
    if (const auto kept =
            write_file(options.readings, force_table_text(measured->forces.readings, !is_trusted), {options.table});
        !kept)
      return refuse(kept.error());
  // A simulation's own declaration is the truth that is planted in it, so its gains are held against 1.
  DeclaredDevice before = device->declared;
  if (!is_trusted && options.table.empty()) {
    before.wiring.gain = {1, 1};
    before.wiring.response = {};
    before.wiring.offset = {};
  }
  if (const auto sure = confirm_gains(before, measured->calibration); !sure) return refuse(sure.error());
  const DeclaredDevice result = calibrated(before, measured->calibration);
  nlohmann::ordered_json found = {{"device", device->declared.profile.name}, {"simulated", measured->forces.is_simulated}};
  if (options.json) found.update(calibration_json(measured->calibration, device->declared.profile));
  return is_trusted ? write_measured(options, *device, result, found) : write_simulated(options, result, found);
}

Run declare_calibrate_device(CLI::App& verb) {
  const auto options = std::make_shared<CalibrateDeviceOptions>();
  must_say(
      verb.add_option("--device", options->device,
                      "the device to measure, as `wale feel --device` spells it (default: the best one plugged in)")
          ->type_name("DEVICE"),
      "a device");
  must_say(
      verb.add_option("--table", options->table,
                      "reads the gauge's readings from a table and pushes nothing: columns axis, direction, command "
                      "and reading with their units, and perhaps repeat")
          ->type_name("FILE"),
      "a table");
  must_say(verb.add_option("--readings", options->readings, "keeps the readings as such a table")->type_name("FILE"),
           "a file");
  offer_output(verb, options->out, "a Wale file with the declaration, instead of your trusted file");
  verb.add_flag("--yes", options->yes,
                "writes into your trusted file without asking; a gain far from the declared one is still asked about");
  offer_json(verb, options->json, "prints the figures, their intervals and residuals, and the declaration as JSON");
  offer_force(verb, "--max-force", options->max_force, "the largest force to measure with, as in \"3 N\"");
  offer_duration(verb, "--hold", options->hold, {.most = 60, .example = 4},
                 "how long each push is held for the gauge (default: 4 s)");
  offer_count(verb, "--seed", options->seed, {.example = 7}, "the noise of a simulated device's gauge");
  offer_trusted_files(verb, options->trusted);
  offer_name(verb, "--transport", options->transport, transport_names(),
             "how to drive it, where its driver knows several ways");
  verb.footer(
      "You hold a force gauge, or hang weights on the handle, and type what it shows. Gain, dead band, non-linearity,\n"
      "saturation and offset of each way are fitted, each with a 95 % interval; mass, damping, friction and delay "
      "come\n"
      "from shaking the handle. The declaration is shown before it is written into ~/.config/wale/devices.wale, and\n"
      "forces are corrected by it from then on. What a simulation gives is only printed, or written with -o.\n"
      "for example: wale calibrate device\n"
      "             wale calibrate device --device my_stick --table gauge.csv\n"
      "             wale calibrate device --device simulated:sandpaper -o planted.wale");
  return [options] { return status_after_signals(calibrate_device(*options)); };
}

}  // namespace

extern const Verb calibrate_device_verb{
    "calibrate-device", "measures how hard your device pushes, and corrects it by that", declare_calibrate_device};

}  // namespace wale::command
