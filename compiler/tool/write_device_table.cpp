// write_device_table FILE: a step of the build. It writes the devices that every Wale file knows (calibration/devices)
// as a table for the runtime, which has no compiler. A file that holds them already is left as it is.

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include "compiler/declarations/declared_devices.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/modules/load_modules.hpp"
#include "schema/device_table.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: write_device_table FILE\n", stderr);
    return 2;
  }
  const auto common = wale::common_modules();
  for (const auto& problem : common->problems.all())
    std::fputs(wale::render_text(problem, wale::SourceSet(), false).c_str(), stderr);
  if (common->problems.has_errors()) return 1;

  const auto table = wale::write_device_table(wale::declared_devices(common->declarations));
  const std::string bytes(reinterpret_cast<const char*>(table.data()), table.size());
  std::ifstream old(argv[1], std::ios::binary);
  if (old && bytes == std::string(std::istreambuf_iterator<char>(old), {})) return 0;
  std::ofstream file(argv[1], std::ios::binary);
  if (!(file << bytes << std::flush)) {
    std::fprintf(stderr, "write_device_table: cannot write %s\n", argv[1]);
    return 1;
  }
  return 0;
}
