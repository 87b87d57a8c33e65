#pragma once

#include <QString>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>
#include <wale/language_service.hpp>

namespace sandpaper {

/// A patch as the document holds it. It never changes: an edit makes a new one, so that undo keeps the old one.
struct Placed {
  std::uint64_t id = 0;  ///< stays the same while the patch is moved, turned into another material or renamed
  wale::LaidOutPatch patch;
  std::string compiled_from;             ///< the material's text without what sliders have changed since
  std::map<std::string, float> sliders;  ///< parameters that sliders have moved, SI
  bool away = false;                     ///< not on the stage now: while somebody sorts, only the chosen one is
  bool locked = false;                   ///< the mouse and the arrow keys leave it where it is; not kept in the file

  /// Whether it can be laid out; otherwise it is only kept as its author wrote it.
  bool is_laid_out() const { return patch.verbatim.empty(); }
  /// Whether it can be changed here; an area of a picture is changed in the text.
  bool is_changeable() const { return is_laid_out() && !patch.is_of_picture; }
};

using PlacedRef = std::shared_ptr<const Placed>;

/// All that a file holds: a workspace, and the text around it, which declares materials of its own. A value.
struct Contents {
  std::string name, documentation, trailing;  ///< of the workspace
  std::vector<PlacedRef> placed;              ///< the last in front
  std::string head, tail;                     ///< the file's text before and behind the workspace
  std::shared_ptr<const wale::WrittenLayout> written = {};  ///< where the workspace was read
  std::string file;                           ///< the path beside which imports and pictures are looked for

  const Placed* find(std::uint64_t id) const;
  /// What the materials of the patches are compiled with: the file, with its workspace empty but for the names that
  /// movies, keys and groups of the file may have of it. The same while patches are moved or changed.
  std::string surroundings() const;
  /// A name for a new patch that no other has: "oak", "oak_2", …
  std::string new_name(const std::string& like) const;
  /// The names that the file declares, besides those of patches.
  std::set<std::string> declared() const;
  /// A name for a new declaration that nothing in the file has.
  std::string new_declared_name(const std::string& like) const;
  wale::Layout layout() const;
};

/// A material with an argument of that name set to a text: `denim(roughness: 0.3)` from `denim`. Nothing if the text is
/// neither a name nor one call, as `0.5 a + 0.5 b`.
std::optional<std::string> with_argument(const std::string& made_of, const std::string& name, const std::string& value);

/// The same without that argument.
std::string without_argument(const std::string& made_of, const std::string& name);

/// A number as a Wale file has it, with the unit in which its author reads it: "2.5 mm".
std::string written(double si, const std::string& unit, double unit_in_si);

}  // namespace sandpaper
