#include "compiler/command/manual.hpp"

#include <CLI/CLI.hpp>
#include <memory>

#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/diagnostics/explain.hpp"
#include "compiler/modules/find_materials.hpp"
#include "compiler/text/output_file.hpp"

namespace wale::command {
namespace {

struct ManualOptions {
  std::string folder;
};

CompletedNames names_to_complete() {
  const auto known = declared_everywhere();
  CompletedNames names{known->declarations.percept_spellings(), known->declarations.devices.spellings(), {}, {}};
  for (const Code code : all_codes()) names.codes.push_back(code_name(code));
  names.kinds = kinds_in(*library_index(*file_resolver({}), "here"));
  return names;
}

int manual(const ManualOptions& options, const CLI::App& all) {
  const CompletedNames names = names_to_complete();
  std::vector<std::pair<std::string, std::string>> files = {{"wale.1", manual_page(all, nullptr)},
                                                            {"wale.bash", bash_completion(all, names)},
                                                            {"_wale", zsh_completion(all, names)}};
  for (const CLI::App* verb : listed_verbs(all))
    files.emplace_back("wale-" + verb->get_name() + ".1", manual_page(all, verb));
  for (const auto& [name, text] : files)
    if (const auto written = write_file(options.folder + "/" + name, text, {}); !written)
      return refuse(written.error());
  return done;
}

Run declare_manual(CLI::App& verb) {
  const auto options = std::make_shared<ManualOptions>();
  must_say(verb.add_option("DIR", options->folder, "the folder to write to"), "a folder")->required();
  verb.group("");  // for packages: no help lists it
  verb.footer("for example: wale manual build/manual");
  return [options, all = verb.get_parent()] { return manual(*options, *all); };
}

}  // namespace

extern const Verb manual_verb{
    "manual", "writes the manual pages and the completions of this program for bash and zsh into a folder",
    declare_manual};

}  // namespace wale::command
