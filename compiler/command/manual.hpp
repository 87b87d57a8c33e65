#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace wale::command {

/// The manual page of the whole command line (`verb` null) or of one verb, as roff for man(7), from its options.
std::string manual_page(const CLI::App& all, const CLI::App* verb);

/// The names that completion proposes besides the verbs and their options.
struct CompletedNames {
  std::vector<std::string> percepts, devices, codes, kinds;
};

/// The completion of the command line for a shell. Names of materials are asked for when they are completed, by
/// `wale find`: a folder may have its own.
std::string bash_completion(const CLI::App& all, const CompletedNames& names);
std::string zsh_completion(const CLI::App& all, const CompletedNames& names);

/// The verbs that `wale --help` lists.
std::vector<const CLI::App*> listed_verbs(const CLI::App& all);

}  // namespace wale::command
