#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "compiler/open_file.hpp"
#include "compiler/read/cues.hpp"
#include "wale/result.hpp"

namespace wale {

/// A level that a material asks for, and what the finished program reads.
struct ReviewedLevel {
  std::string percept;   ///< "roughness"
  double level = 0;      ///< 0 .. 1
  std::string evidence;  ///< "estimated"; empty if the author does not say how well it is known
  std::optional<double> reads;  ///< nothing if no map tells it
};

/// What only a compilation tells of a material.
struct MaterialFacts {
  std::string name;
  std::optional<Cues> cues;           ///< nothing for a material with an error
  std::vector<ReviewedLevel> levels;  ///< in the order written
  bool compiled = false;              ///< it has no error; without, nothing below is known
  std::string standing;               ///< of its grade: "stable in the hand"; empty where none was asked for
  double given = 0;                   ///< W that it gives to the hand by itself; 0 if it gives none
  double damping = 0;                 ///< N s/m that the loop needs
  double newton = 0;                  ///< the largest force that was found, N
};

/// The materials of one file, in the order written, and all that they rest on.
struct FileFacts {
  std::vector<MaterialFacts> materials;
  /// All paths that were looked for, found or not, each once, in order.
  std::vector<std::string> looked_for;
  /// It names materials that it does not import, so that any change of the library may change it.
  bool uses_names = false;
};

/// The files that were opened for a review, with what was found.
struct FactsReading {
  OpenedFile opened;  ///< with the diagnostics of the file and of all its materials
  FileFacts facts;
};

/// What is asked of a reading.
struct FactsRequest {
  FileRequest file;                 ///< `file` names a path, a module or a material
  std::string material;             ///< empty for all of the file
  bool cues_alone = false;          ///< what tells it from others, and nothing else
  std::vector<std::string> others;  ///< devices of other classes, for which it must compile as well
};

/// Compiles the materials of one file, reads their programs and, unless only cues are asked for, grades them, builds
/// them for other devices and draws a small picture of each; reports what is wrong with that (W0911 to W0914), and energy
/// that nobody declared where the compiler did not speak of it (W0604).
/// Thread-safe. Errors: those of `open_file`, W0506 for a patch program, W0504 without the library that draws.
Result<FactsReading> read_facts(const FactsRequest& request);

/// The first declared device of each class but that of `device`: one for each other way in which materials are felt.
std::vector<std::string> devices_of_other_classes(const Declarations& declarations, const std::string& device);

}  // namespace wale
