#pragma once

#include <gtest/gtest.h>

#include <string>

#include "compiler/grade/grade.hpp"
#include "tests/compiler/compiling.hpp"

namespace wale::grading {

/// A hand on circles with a radius of 40 mm at 1 Hz.
inline const GradingHand hand{.damping = 6.5, .radius = 0.04, .frequency = 1, .name = "test"};

/// The grade of a material with the block `physical`, compiled with other declarations for a device of them or a
/// shipped one.
inline Grade graded(const std::string& physical, const std::string& declarations = "",
                    const std::string& device = default_device) {
  compiling::Files files;
  SourceSet sources;
  Diagnostics diagnostics;
  const SourceId source =
      sources.add("test.wale", "wale 1\n" + declarations + "\nmaterial m {\n  physical {\n" + physical + "\n  }\n}\n");
  const auto program = compile(sources, source, "", device, files, diagnostics);
  std::string reasons;
  for (const auto& diagnostic : diagnostics.all()) reasons += render_text(diagnostic, sources, false);
  if (!program) throw std::runtime_error(reasons);
  return grade(Bank(*program), hand);
}

/// A device `bench` with the figures of Minsky's joystick; `more` are further settings.
inline std::string device(const std::string& more) {
  return "device bench {\n  workspace disc(228.6 mm)\n  position 4096 counts\n  force 10 N, 2048 counts\n  rate 900 "
         "Hz\n"
         "  speed 1 m/s\n  slew 200 N/s\n  velocity_filter 15, 1 counts\n  patch 160 mm, 160 mm, 5 mm\n" +
         more + "\n  source \"a test\"\n}\n";
}

}  // namespace wale::grading
