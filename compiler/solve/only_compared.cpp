#include "compiler/solve/only_compared.hpp"

namespace wale {

std::string instead_of_a_level(const Percept& percept) {
  switch (percept.extractor) {
    case Extractor::periodicity:
      return "leave it out: of a finished material, `wale describe` says how regular its texture is, and "
             "`wale compare` compares the regularity";
    case Extractor::steepness:
      return "leave it out: of a finished material, `wale describe --json` has the steepness of its texture "
             "(`steepness_per_m`), and `wale compare` compares how abruptly a regular one pushes (`abruptness`)";
    default: return "leave it out: of a finished material, `wale compare` compares the size that it is read from";
  }
}

}  // namespace wale
