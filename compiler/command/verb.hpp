#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace wale::command {

/// Runs a verb whose options have been read, and returns the exit status: `done`, `refused` or `misused`.
using Run = std::function<int()>;

/// One verb of the command line: `FOLDER/command/VERB.cpp` defines it, and `wale.cpp` lists it.
///
/// `declare` adds the options to `verb` and returns the function to run after they are read. The options live in a
/// struct of that file, which `declare` and the returned function share by pointer.
struct Verb {
  const char* name;   ///< "check"
  const char* about;  ///< one line of `wale --help`
  Run (*declare)(CLI::App& verb);
};

}  // namespace wale::command
