#pragma once

#include <string>
#include <vector>

namespace wale {

/// Where to look for a program or library that comes with this one, best first: beside the running program, in
/// `../libexec/wale` from there, and `built`, the path in the tree in which it was built. Neither PATH nor the present
/// folder is searched.
std::vector<std::string> companion_paths(const std::string& name, const std::string& built);

}  // namespace wale
