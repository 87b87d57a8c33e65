#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/text/json_text.hpp"
#include "compiler/text/other_file.hpp"
#include "compiler/text/output_file.hpp"
#include "compiler/text/readable.hpp"
#include "compiler/text/resolver.hpp"
#include "schema/spelling.hpp"
#include "schema/visible_text.hpp"
#include "wale/recording.hpp"

namespace wale::command {
namespace {

/// The overview of a recording.
struct Summary {
  std::vector<std::string> materials;  ///< the materials of its programs, with their hashes
  long sets = 0, swaps = 0, moves = 0, placements = 0, missed = 0;
  double seconds = 0;
};

std::string material_of(const RecordedProgram& program) {
  const auto read = read_patch_program(program.bytes);
  return fmt::format("{} {:016x}", read ? visible_text(read->material) : "a program that cannot be read", program.hash);
}

Summary summary_of(const Recording& recording) {
  Summary summary;
  for (const RecordedProgram& program : recording.programs()) summary.materials.push_back(material_of(program));
  std::map<std::uint32_t, std::size_t> programs;  // by the patch's number
  for (const RecordedEvent& event : recording.events()) {
    summary.sets += event.kind == RecordedEvent::Kind::set;
    summary.swaps += event.kind == RecordedEvent::Kind::replace;
    summary.moves += event.kind == RecordedEvent::Kind::move;
    summary.placements += event.kind == RecordedEvent::Kind::place || event.kind == RecordedEvent::Kind::add;
    if (event.kind == RecordedEvent::Kind::remove) programs.erase(event.patch);
    if (event.kind != RecordedEvent::Kind::put) continue;
    const bool is_new = programs.insert_or_assign(event.patch, event.program).second;
    summary.placements += is_new;
    summary.swaps += !is_new && event.renewed;
  }
  for (std::size_t i = 0; i < recording.ticks(); ++i) summary.missed += recording.tick(i).skipped;
  if (recording.ticks() > 0)
    summary.seconds =
        static_cast<double>(recording.tick(recording.ticks() - 1).period + 1) / recording.header().device.rate;
  return summary;
}

std::string verdict(const Replay& replay, double rate) {
  if (!replay.first) return "the same, bit for bit";
  const ReplayDifference& first = *replay.first;
  return fmt::format(
      "differs on {} of {} ticks, first on tick {} counted from 0 ({:.4f} s without missed periods): the {} was {:.9g} "
      "and is "
      "{:.9g}; "
      "the commands differ by at most {:.3g}",
      replay.differing, replay.ticks, first.tick, static_cast<double>(first.tick) / rate, first.what, first.recorded,
      first.replayed, replay.largest_force);
}

std::string replay_text(const std::string& file, const Recording& recording, const Replay& replay) {
  const RecordingHeader& header = recording.header();
  const Summary summary = summary_of(recording);
  std::string text = readable("{}: {} on the {}{}{}, {:.4g} s{}\n", visible_text(file),
                              recording.complete() ? "a run" : "the beginning of a run", header.device.name,
                              header.hand.empty() ? "" : ", ", visible_text(header.hand), summary.seconds,
                              header.virtual_time ? " of virtual time" : "");
  text += readable("  ticks        {} run, {} missed, at {:.4g} Hz\n", recording.ticks(), summary.missed,
                   header.device.rate);
  for (const std::string& material : summary.materials) text += readable("  program      {}\n", material);
  text += readable("  changes      {} placed, {} moved, {} replaced, {} parameters set\n", summary.placements,
                   summary.moves, summary.swaps, summary.sets);
  return text + fmt::format("  replay       {}\n", verdict(replay, header.device.rate));
}

std::string replay_json(const std::string& file, const Recording& recording, const Replay& replay) {
  const RecordingHeader& header = recording.header();
  const Summary summary = summary_of(recording);
  nlohmann::ordered_json json;
  json["file"] = file;
  json["profile"] = header.device.name;
  json["hand"] = header.hand;
  json["virtual_time"] = header.virtual_time;
  json["complete"] = recording.complete();
  json["seconds"] = summary.seconds;
  json["ticks"] = {{"run", recording.ticks()}, {"missed", summary.missed}};
  json["programs"] = summary.materials;
  json["changes"] = {{"placed", summary.placements},
                     {"moved", summary.moves},
                     {"swapped", summary.swaps},
                     {"parameters_set", summary.sets}};
  json["replay"] = {{"same", !replay.first}, {"differing", replay.differing}};
  if (replay.first)
    json["replay"]["first"] = {{"tick", replay.first->tick},
                               {"what", replay.first->what},
                               {"recorded", replay.first->recorded},
                               {"replayed", replay.first->replayed}};
  return json_lines(json);
}

/// Writes a file by `write`, unless `path` is empty.
template <class Write>
Result<> exported(const std::string& path, const InputFiles& inputs, Write&& write) {
  if (path.empty()) return {};
  auto out = OutputFile::open(path, inputs);
  if (!out) return out.error();
  if (Result<> written = write(out->stream()); !written) return written;
  return out->finish();
}

/// Says what a file is that is no recording.
Error with_kind(Error error, const std::string& path) {
  const auto read = error.code == Code::damaged_file ? read_file(path) : Result<ResolvedFile>(error);
  if (!read || read->bytes.starts_with("\x89WRC")) return error;
  if (const auto other = other_file(path, read->bytes))
    error.sentence = fmt::format("expected a recording, found {}", other->what);
  else if (read->bytes.starts_with("wale"))
    error.sentence = "expected a recording, found a Wale file";
  return error;
}

struct ReplayOptions {
  std::string file, csv, wav;
  std::optional<std::uint64_t> ticks;  ///< at most this many, from the beginning
  bool json = false;
};

/// An error of the runtime in the words of the command line.
Error as_option(Error error) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 2> words{
      {{"(`most_ticks`)", "(`--ticks`)"},
       {"record a run into a file NAME.wrec, and open that", "make one with `wale feel FILE --record NAME.wrec`"}}};
  for (const auto& [argument, option] : words)
    if (const std::size_t at = error.mend.find(argument); at != std::string::npos)
      error.mend.replace(at, argument.size(), option);
  return error;
}

int replay(const ReplayOptions& options) {
  if (!options.wav.empty() && !has_ending(options.wav, ".wav") && !is_written_as_it_comes(options.wav))
    return refuse(Error{.code = Code::malformed_value,
                        .sentence = fmt::format("expected a file NAME.wav, found `{}`", options.wav),
                        .place = {.name = "--wav", .text = options.wav}});
  if (!options.csv.empty() && !options.wav.empty() && is_same_output(options.csv, options.wav))
    return refuse(Error{.code = Code::malformed_value,
                        .sentence = fmt::format("expected another file than that of --csv, found `{}`", options.wav),
                        .mend = "the table and the sound are two files: give each a name of its own",
                        .place = {.name = "--wav", .text = options.wav}});
  const auto opened = Recording::open(options.file, options.ticks.value_or(SIZE_MAX));
  if (!opened) return refuse(with_kind(as_option(opened.error()), options.file));
  const auto& recording = *opened;
  const auto table = exported(options.csv, {options.file}, [&](std::ostream& out) {
    write_csv(out, recording);
    return Result<>();
  });
  if (!table) return refuse(table.error());
  const auto sound =
      exported(options.wav, {options.file}, [&](std::ostream& out) { return write_wav(out, recording); });
  if (!sound) return refuse(as_option(sound.error()));
  const auto replayed = wale::replay(recording);
  if (!replayed) return refuse(replayed.error());
  const auto& result = *replayed;
  print_out(options.json ? replay_json(options.file, recording, result) : replay_text(options.file, recording, result));
  return result.first ? refused : done;
}

Run declare_replay(CLI::App& verb) {
  const auto options = std::make_shared<ReplayOptions>();
  verb.add_option("FILE", options->file, "a recording, made by `wale feel corduroy --record corduroy.wrec`")
      ->required();
  verb.add_option("--csv", options->csv,
                  "also writes a table with a line for each tick, with units in its first line, as in ticks.csv; an "
                  "existing file is replaced")
      ->type_name("FILE");
  verb.add_option(
          "--wav", options->wav,
          "also writes the force as sound, 44.1 kHz, as in corduroy.wav: x left, y right; the device's peak force is "
          "full scale; an existing file is replaced")
      ->type_name("FILE");
  offer_count(verb, "--ticks", options->ticks, {.least = 1, .example = 900},
              "reads only the first N ticks, as in 900 for the first second at 900 Hz (default: all); so a damaged "
              "recording can be read up to the damage");
  offer_json(verb, options->json, "the result as a JSON object");
  verb.footer("for example: wale replay corduroy.wrec --wav corduroy.wav");
  return [options] { return replay(*options); };
}

}  // namespace

extern const Verb replay_verb{"replay", "runs a recording's programs again on the recorded positions, and compares",
                              declare_replay};

}  // namespace wale::command
