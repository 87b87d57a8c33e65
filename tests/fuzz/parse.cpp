// A libFuzzer target for the front end: any bytes at all are read, printed and reported on without a crash.
// cmake --preset fuzz && cmake --build --preset fuzz && build-fuzz/tests/fuzz_parse library/

#include "compiler/parse.hpp"

#include "compiler/print_tree.hpp"
#include "compiler/render.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* bytes, std::size_t size) {
  wale::SourceSet sources;
  wale::Diagnostics diagnostics;
  const auto source = sources.add("fuzz.wale", std::string(reinterpret_cast<const char*>(bytes), size));
  print_tree(parse(sources, source, diagnostics));
  render_json(diagnostics, sources);
  for (const wale::Diagnostic& each : diagnostics.all()) render_text(each, sources, true);
  return 0;
}
