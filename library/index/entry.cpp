#include "library/index/entry.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "compiler/compile_to_read.hpp"
#include "compiler/describe/describe_extracted.hpp"
#include "compiler/describe/describe_percept.hpp"
#include "compiler/diagnostics/told.hpp"
#include "compiler/parse/parse.hpp"
#include "compiler/text/resolver.hpp"
#include "library/index/content_hash.hpp"
#include "library/licence/passing_on.hpp"

namespace wale {
namespace {

EntryPercept entry_percept(const DescribedPercept& told) {
  EntryPercept percept{.name = told.name,
                       .asked = told.asked,
                       .claimed = told.claimed,
                       .reads = std::nullopt,
                       .saturated = told.saturated,
                       .carrier = told.carrier,
                       .size = told.amplitude,
                       .unit = told.unit,
                       .slope = told.slope,
                       .anchor = told.anchor,
                       .handle = told.handle,
                       .domain = told.domain,
                       .map = told.map,
                       .device = told.device,
                       .source = told.source};
  for (const OutsideRange& each : told.outside) percept.outside.push_back(in_words(each));
  if (told.unknown || !std::isfinite(told.level)) return percept;
  percept.reads = told.level, percept.means = told.intervals.means;
  percept.means_differ_more = told.intervals.means_differ_more, percept.people = told.intervals.people;
  return percept;
}

/// Adds the percepts that were asked for and that the device cannot give, and brings all into the order asked for.
void add_lost(std::vector<EntryPercept>& percepts, const PatchProgram& program) {
  std::vector<EntryPercept> ordered;
  for (const FateRecord& fate : program.fates) {
    if (!fate.percept) continue;
    const auto found = std::ranges::find(percepts, fate.name, &EntryPercept::name);
    if (found != percepts.end()) {
      found->lost = fate.fate == Fate::lost;
      ordered.push_back(std::move(*found));
      percepts.erase(found);
    } else if (fate.fate == Fate::lost) {
      EntryPercept& lost = ordered.emplace_back();
      lost.name = fate.name, lost.asked = fate.asked, lost.lost = true;
      const auto claim = std::ranges::find(program.claims, fate.name, &LevelClaim::percept);
      if (claim != program.claims.end()) lost.claimed = claim->evidence;
    }
  }
  std::ranges::move(percepts, std::back_inserter(ordered));
  percepts = std::move(ordered);
}

std::string first_part(const std::string& dotted) { return dotted.substr(0, dotted.find('.')); }

/// All that the materials of a file rest on, but for their names.
std::string base_of(const FileEntries& read, const std::string& device) {
  ContentHash hash;
  hash.take(compiler_build()).take(device);
  std::set<std::string> told;
  hash.take(read.opened.sources[read.opened.source].text);
  // A shipped file is part of the build.
  for (std::size_t i = 0; i < read.opened.sources.size(); ++i) {
    const Source& source = read.opened.sources[static_cast<SourceId>(i)];
    told.insert(source.name);
    if (i != read.opened.source) hash.take(source.text);
  }
  for (const std::string& path : read.looked_for)
    if (!told.contains(path))
      if (const auto found = read_file(path, largest_asset)) hash.take(found->bytes);
  return hash.digits();
}

std::string first_error(const Diagnostics& diagnostics) {
  for (const Diagnostic& each : diagnostics.all())
    if (severity_of(each.code) == Severity::error) return each.message;
  return "it cannot be built";
}

EntryFeel felt_again(const Program& program, const Declarations& declarations, ReadFirst& first) {
  const Bank bank(program);
  const PatchProgram& built = program.description();
  EntryFeel felt;
  Description description{.material = built.material, .device = built.device, .patch = bank.size()};
  if (built.vibrates()) {
    description.percepts = recorded_percepts(bank, {}, declarations);
  } else {
    const ForceReading reading = read_again(bank, declarations, {}, first);
    felt.cues = cues_of(bank, reading);
    description.percepts = recorded_percepts(bank, reading, declarations);
    describe_extracted(description, bank, reading, declarations);
  }
  for (const DescribedPercept& each : description.percepts) felt.percepts.push_back(entry_percept(each));
  add_lost(felt.percepts, built);
  return felt;
}

/// Builds one material and reads it.
void compile_entry(Entry& entry, FileEntries& read, const FileRequest& request, const Feel& feel, KeptReadings* kept) {
  Diagnostics diagnostics;
  const auto resolver = file_resolver(request.roots, request.looked_for, request.sandbox, request.devices);
  ReadFirst first;
  first.kept = kept;
  const auto program = compile_to_read(*read.opened.module, entry.name, request.device, read.opened.sources,
                                       read.opened.source, *resolver, diagnostics, first);
  for (const Diagnostic& each : diagnostics.all()) read.opened.diagnostics.report(each);
  if (!program) {
    entry.trouble = first_error(diagnostics);
    return;
  }
  entry.device = program->description().device.name;
  entry.parameters = program->description().parameters;
  entry.program = write_patch_program(program->description());
  // The program differs from the one that was measured in fates alone, so its reading need not begin anew.
  const auto* own = feel.target<EntryFeel (*)(const Program&, const Declarations&)>();
  const Declarations& declarations = read.opened.module->declarations();
  entry.felt = own && *own == felt_of ? felt_again(*program, declarations, first) : feel(*program, declarations);
}

}  // namespace

Evidence EntryPercept::evidence() const { return std::max({slope, anchor, handle, domain.value_or(slope)}); }

const EntryPercept* EntryFeel::percept(const std::string& name) const {
  const auto found = std::ranges::find(percepts, name, &EntryPercept::name);
  return found == percepts.end() ? nullptr : &*found;
}

EntryFeel felt_of(const Program& program, const Declarations& declarations) {
  ReadFirst first;
  return felt_again(program, declarations, first);
}

Entry entry_of(const IndexedMaterial& material) {
  Entry entry{.name = material.name,
              .module = material.module,
              .file = material.file,
              .folder = first_part(material.kind.empty() ? material.module : material.kind),
              .kind = material.kind,
              .title = material.title,
              .documentation = material.documentation,
              .feels = material.feels,
              .asks = material.asks,
              .replaces = material.replaces,
              .sources = material.sources,
              .licence = material.licence};
  for (const std::string& name : material.called) entry.names.push_back({"en", name});
  for (const auto& [language, names] : material.called_in)
    for (const std::string& name : names) entry.names.push_back({language, name});
  return entry;
}

Result<FileEntries> read_entries(const FileRequest& request, const std::string& module, const Feel& feel,
                                 KeptReadings* kept) {
  FileEntries read;
  FileRequest watched = request;
  watched.looked_for = &read.looked_for;
  auto opened = open_file(watched);
  if (!opened) return opened.error();
  read.opened = *std::move(opened);
  if (!read.opened.module)
    return Error{.code = Code::damaged_file,
                 .sentence = "a patch program is no text of a library",
                 .mend = "name the Wale file that it was built from",
                 .place = {.name = request.file}};
  for (const auto& each : read.opened.module->modules.modules)
    read.uses_names |= !each->declarations.library_materials.empty();

  Diagnostics again;  // of what has been reported
  LibraryIndex index;
  index.add(module, request.file, parse(read.opened.sources, read.opened.source, again));
  // What is in this binary is in the public domain (library/LICENSE).
  const std::string licence = read.opened.is_on_disk ? licence_over(request.file) : "CC0-1.0";
  for (const IndexedMaterial& material : index.materials()) {
    if (!read.opened.material.empty() && material.name != read.opened.material) continue;
    Entry& entry = read.entries.emplace_back(entry_of(material));
    entry.device = request.device;
    if (entry.licence.empty()) entry.licence = licence;
    if (!read.opened.diagnostics.has_errors()) {
      compile_entry(entry, read, watched, feel, kept);
      continue;
    }
    entry.trouble = first_error(read.opened.diagnostics);
  }
  if (read.entries.empty())
    for (const Diagnostic& each : read.opened.diagnostics.all())
      if (!read.unparsed && severity_of(each.code) == Severity::error) read.unparsed = told(each, read.opened.sources);
  std::ranges::sort(read.looked_for);
  read.looked_for.erase(std::unique(read.looked_for.begin(), read.looked_for.end()), read.looked_for.end());
  const std::string base = base_of(read, request.device);
  for (Entry& entry : read.entries) entry.content = ContentHash().take(base).take(entry.name).digits();
  return read;
}

}  // namespace wale
