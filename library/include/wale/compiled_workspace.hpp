#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "wale/result.hpp"
#include "wale/workspace.hpp"

namespace wale {

/// Bytes `begin` up to but not including `end` of a text.
struct TextPart {
  std::size_t begin = 0, end = 0;

  friend bool operator==(const TextPart&, const TextPart&) = default;
};

/// Where a patch stands in its text.
struct PatchInText {
  TextPart statement;  ///< `patch board = oak { … }`; of a colour of a picture `colour "#c04020" = brick`
  TextPart name;       ///< `board`; of a colour its text in quotes
  TextPart material;   ///< `oak`
  /// The settings in its braces in the order written, by their first word: {"at", …}. The marks are in the order of
  /// `WorkspacePatch::marks`. None of a colour.
  std::vector<std::pair<std::string, TextPart>> settings;
  std::string colour;  ///< "#c04020" of the picture's; empty for other patches
};

/// A workspace of a text, compiled for a device.
struct CompiledWorkspace {
  Workspace workspace;
  std::vector<PatchInText> in_text;  ///< of each patch; none for a workspace file
  TextPart statement, name;          ///< of the whole declaration
  std::vector<Error> warnings = {};  ///< in the order of their places; `severity_of` their codes is `warning`
};

/// How a text's workspace is compiled.
struct WorkspaceOptions {
  std::string device = {};     ///< as in `CompileOptions`
  std::string workspace = {};  ///< which of the text; empty: the first
  std::string name = "text";   ///< of a text in memory, as in `CompileOptions`
  /// Whether to warn also of what a hand cannot tell, as `wale check` does. It reads every program: up to a second
  /// each.
  bool legibility = false;
};

/// `movie demo { frames kitchen, workshop }`.
struct Movie {
  std::string name, documentation;
  std::vector<std::string> frames;  ///< names of workspaces
  TextPart statement;
};

/// `keys sorting { of kitchen; area 80 mm, 80 mm }`: each patch of a workspace is chosen by a key with the mouse, and
/// felt in one area. Lengths are in m.
struct MiniKeys {
  std::string name, documentation;
  std::string workspace;
  std::array<double, 2> area{};     ///< width and height
  std::array<double, 2> at{};       ///< the area's centre, from the workspace's centre
  std::optional<double> key;        ///< the side of a key, if it is given
  bool numbered_at_random = false;  ///< three digits on each, new before each sort; otherwise the patches' names
  TextPart statement;
};

/// `groups sorted { of kitchen; group board, cloth, "rough" }`: how somebody sorted the patches of a workspace.
struct SortedGroups {
  struct Group {
    std::vector<std::string> patches;
    std::string says;  ///< may be empty
  };
  std::string name, documentation;
  std::string workspace;
  std::vector<Group> groups;
  TextPart statement;
};

/// What a text declares for people to explore: its workspaces by name, and how they are shown.
struct Presentation {
  std::vector<std::string> workspaces;  ///< in the order written, as all others
  std::vector<Movie> movies;
  std::vector<MiniKeys> keys;
  std::vector<SortedGroups> groups;
};

}  // namespace wale
