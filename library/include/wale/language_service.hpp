#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "wale/library.hpp"
#include "wale/shape.hpp"
#include "wale/workspace.hpp"

namespace wale {

/// Text that replaces the bytes `begin` up to but not including `end` of a text; where they are equal it is inserted.
struct TextEdit {
  std::size_t begin = 0, end = 0;
  std::string replacement;
};

/// A correction that an editor can offer: all of its edits or none.
struct TextFix {
  std::string title;  ///< what it does: "write `roughness`"
  std::vector<TextEdit> edits;
  bool safe = false;  ///< no other meaning is possible
};

/// An error or a warning, with its place as bytes of the text that was checked.
struct Problem {
  Error error;
  std::size_t begin = 0, end = 0;  ///< both 0 for a problem in another file, which `error.place` names
  std::vector<TextFix> fixes;      ///< the likeliest first
};

/// What a part of a text is, for its colour.
enum class WordKind { comment, documentation, keyword, name, number, unit, text, symbol };

/// A part of a text.
struct ColouredWord {
  std::size_t begin = 0, end = 0;  ///< bytes
  WordKind kind = WordKind::name;
};

/// What a proposed word means.
enum class ProposalKind { keyword, percept, level, unit, function, constant, parameter, material };

/// A word that may stand where someone is typing.
struct Proposal {
  std::string text;
  ProposalKind kind = ProposalKind::keyword;
  std::string documentation;  ///< may be empty
};

/// What may stand at a place, in place of the bytes `begin` up to `end`, which are the beginning of a word.
struct Proposals {
  std::size_t begin = 0, end = 0;
  std::vector<Proposal> words;  ///< in alphabetic order, kind by kind
};

/// A mark of a slider as it is written: its ends are in SI, and `unit` is the one that the author reads.
struct LaidOutMark {
  WorkspaceMark mark;
  std::string unit;  ///< "mm"; empty for a level or a plain number
  double unit_in_si = 1;
};

struct WrittenPatch;   // private to the library: a patch in the text that it was read from
struct WrittenLayout;  // and a workspace

/// A patch as a workspace declares it, with all that its author wrote.
struct LaidOutPatch {
  std::string name;
  std::string made_of;             ///< as written: "denim(roughness: 0.3)"
  glm::dvec2 at{0};                ///< m from the workspace's centre, of the patch's centre
  bool at_is_written = false;      ///< also where it is the workspace's centre, which needs not be written
  std::optional<glm::dvec2> size;  ///< m, if it is written
  std::string shape;  ///< as written: "ellipse", "mask(\"river.png\", scale: 0.5 mm/px)"; empty without one
  Shape outline;      ///< what that is; `outline.size()` is its own size, of an ellipse that of a circle of 1 m
  std::optional<double> rim;       ///< m, if it is written
  std::vector<LaidOutMark> marks;
  bool on_one_line = false;  ///< its braces are on the line of its name
  std::string before;  ///< the comments and the documentation in front, in whole lines
  std::string inside;  ///< the comments in and directly behind the declaration, in whole lines
  /// A statement that is kept as it is written, such as `patches from picture(…) { … }` or a patch with an error; then
  /// of the others only `before` counts, and `name` may be empty.
  std::string verbatim;
  /// It is an area of a picture, laid out by the statement that is kept before it: it is felt, and is not written
  /// itself.
  bool is_of_picture = false;
  std::shared_ptr<const WrittenPatch> written = {};  ///< where it was read; null for a new one
};

/// A workspace as its file declares it: what a window changes and writes back.
struct Layout {
  std::string name;
  std::string documentation;           ///< the text of its `///` comments, in lines
  std::vector<LaidOutPatch> patches;   ///< the last in front
  std::string trailing;                ///< the comments behind the last patch, in whole lines
  std::size_t begin = 0, end = 0;      ///< bytes of the declaration with its documentation in the text that was read
  std::shared_ptr<const WrittenLayout> written = {};  ///< where it was read; null for a new one
};

/// The declaration of a workspace as text, without a newline at its end. What `check` reads in it is the same layout
/// again. What was read from a text and has not changed is as its author wrote it, to the byte: of a patch only the
/// settings that changed are written anew. New patches, and those that lost a setting or a comment, have the standard
/// style.
std::string layout_text(const Layout& layout);

/// A Wale text after the checks that need no device.
struct CheckedText {
  std::vector<Problem> problems;       ///< in the order of their places
  std::vector<std::string> materials;  ///< the text's own, in the order written
  std::vector<Layout> layouts;         ///< its workspaces, in the order written
  bool has_errors() const;
};

/// One material of a text, compiled.
struct CompiledText {
  std::optional<Program> program;  ///< nothing after errors
  std::vector<Problem> problems;   ///< errors and warnings of all stages, in the order of their places
};

/// A percept of a material: what was asked for, what the finished program reads as, and on what evidence.
struct ToldPercept {
  std::string name;
  std::optional<double> asked;  ///< a level
  std::optional<double> reads;  ///< a level; nothing where no map tells it
  std::string evidence;         ///< "measured", "published", "extrapolated", …
  std::string why;              ///< why the level is unknown, or was not measured; mostly empty
};

/// A material in words and figures.
struct ToldMaterial {
  std::vector<ToldPercept> percepts;
  std::string text;  ///< what `wale describe` prints, several lines
};

/// A program with the values and the size with which it is felt.
struct PlacedProgram {
  Program program;
  std::vector<float> parameters;  ///< SI, in the order of its description
  PatchSize size;
  std::string called = {};  ///< as a comparison calls it; empty: by the program's name
};

/// A picture of a material, or a plot of its force.
struct PreviewPart {
  std::string name;   ///< "surface" or "field"; "height", "force", "velocity", "hand", "time", "spectrum"; each once
  std::string title;  ///< "Force along x"; empty for the surface and the field
  std::vector<std::byte> png;
};

/// What an editor of Wale texts needs. The answers are those of the command line.
///
/// All calls are safe from any thread, also at the same time; none is for a real-time thread. They need a stack of 8
/// MB. `check` and `proposals` take some milliseconds for a usual file, `compile`, `tell` and `compare` up to a second.
class LanguageService {
 public:
  explicit LanguageService(const LibraryOptions& options = {});
  ~LanguageService();
  LanguageService(const LanguageService&) = delete;
  LanguageService& operator=(const LanguageService&) = delete;

  /// Error: `unreadable_file` about the first of `LibraryOptions::folders` that is no folder. `check`, `compile` and
  /// `legibility` have it among their problems.
  Result<> folders_exist() const;

  /// Checks a text; of `options`, `name` and `device` count. Problems about an argument, such as `unknown_device`, come
  /// first, and have its name as `error.place.name`.
  CheckedText check(std::string_view text, const CompileOptions& options = {}) const;

  /// Compiles one material of a text, by default the first. `called`: how the program and the problems call it, as for
  /// a text with a material that only its caller knows; empty: by its name.
  CompiledText compile(std::string_view text, const CompileOptions& options = {}, const std::string& called = {}) const;

  /// What a hand cannot tell on a workspace of the text, and what it does not reach, as `wale check` warns of it; and
  /// the errors of its materials; `unknown_device`, `unknown_workspace`. Reads every program: up to a second each.
  std::vector<Problem> legibility(std::string_view text, const WorkspaceOptions& options = {}) const;

  /// Reads what a program feels like. Without a percept that the author asked for, the program's force is read too,
  /// which takes longer. Error: `unknown_device` if nothing declares the program's device.
  Result<ToldMaterial> tell(const Program& program) const;
  /// The same with these parameters (SI, in the order of its description) in a patch of this size.
  Result<ToldMaterial> tell(const Program& program, std::span<const float> parameters, PatchSize size) const;

  /// Which differences between two programs people notice, cue by cue, as `wale compare` prints it, several lines. Takes
  /// as long as reading both. Errors: `unknown_device`; `other_device` if they are not built for one device that pushes.
  Result<std::string> compare(const PlacedProgram& a, const PlacedProgram& b) const;

  /// The page that `wale preview` draws of a program with these parameters (SI, in the order of its description) in a
  /// patch of this size: relief or field, profile, force, and the spectrum of the force on a stroking hand. The bytes
  /// of a picture in the format that the extension of `name` says: png, svg and others. Takes up to some seconds.
  /// Errors: `unknown_device`; `missing_library` without the drawing library; `malformed_value` for another extension.
  Result<std::vector<std::byte>> preview(const Program& program, std::span<const float> parameters, PatchSize size,
                                         const std::string& name) const;
  /// What such a page is made of, for a window with a layout of its own: the surface or the field in 320 x 320 pixels,
  /// and then the plots in 560 x 280. Errors: `unknown_device`, `missing_library`.
  Result<std::vector<PreviewPart>> preview_parts(const Program& program, std::span<const float> parameters,
                                                 PatchSize size) const;

  /// The text in the standard style. Error: the first one in the text.
  Result<std::string> format(std::string_view text) const;

  /// What may stand at byte `at` of a text, which may have errors.
  Proposals proposals(std::string_view text, std::size_t at, const CompileOptions& options = {}) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// The parts of a text by their kinds, in order; white space is left out. Any bytes are safe.
std::vector<ColouredWord> coloured_words(std::string_view text);

}  // namespace wale
