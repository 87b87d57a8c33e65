#pragma once

#include <string>
#include <vector>

#include "calibration/feel/trusted_declarations.hpp"

namespace CLI {
class App;
}

namespace wale::command {

/// --devices FILE, which may be repeated.
void offer_trusted_files(CLI::App& verb, std::vector<std::string>& files);

/// Where the person at this terminal keeps declarations of their own devices; empty where they have no home.
std::string owners_file();

/// Says that the owner's file has an error, and that nothing in it is used. Call it only if it has one.
void warn_of_owners_file(const TrustedDeclarations& trusted);

/// What this person trusts: the declarations in `files`, then those in their own file, then the shipped ones. An error
/// in their own file is in `owners_problem`.
Result<TrustedDeclarations> trusted_here(const std::vector<std::string>& files);

}  // namespace wale::command
