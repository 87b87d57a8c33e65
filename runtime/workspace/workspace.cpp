#include "wale/workspace.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "runtime/shape/shape_bytes.hpp"
#include "runtime/workspace/format.hpp"
#include "schema/fnv1a.hpp"

namespace wale {
namespace {

using namespace workspace_format;
using Bytes = patch_program_format::ByteReader;

/// Parts of a file, each kept once and numbered in the order of its first use.
class Parts {
 public:
  std::uint32_t number_of(const std::vector<std::byte>& part) {
    const std::string key(reinterpret_cast<const char*>(part.data()), part.size());
    const auto [at, fresh] = numbers_.try_emplace(key, static_cast<std::uint32_t>(numbers_.size()));
    if (fresh) written_ << static_cast<std::uint32_t>(part.size()) << part;
    return at->second;
  }
  void write(ByteWriter& out) const { out << static_cast<std::uint32_t>(numbers_.size()) << written_.result(); }

 private:
  std::map<std::string, std::uint32_t> numbers_;
  ByteWriter written_;
};

void write_mark(ByteWriter& out, const WorkspaceMark& mark) {
  const auto flags = static_cast<std::uint8_t>((mark.is_percept ? mark_of_percept : 0) | (mark.low ? mark_has_low : 0) |
                                               (mark.high ? mark_has_high : 0));
  out << std::string_view(mark.slider) << flags << mark.low.value_or(0) << mark.high.value_or(0)
      << std::string_view(mark.says);
}

/// Reads the parts of a workspace file. Fails with `Error`, thrown.
class WorkspaceReader {
 public:
  explicit WorkspaceReader(std::span<const std::byte> bytes) : in_("the workspace", bytes) {}

  Workspace read() {
    Workspace workspace{in_.text("its name"), in_.text("its description"), {}};
    read_programs();
    read_shapes();
    const std::uint32_t count = in_.count(least_patch, "patches");
    for (std::uint32_t i = 0; i < count; ++i) {
      WorkspacePatch patch = read_patch();
      if (!names_.insert(patch.name).second) in_.damaged(" has two patches called `", patch.name, "`");
      workspace.patches.push_back(std::move(patch));
    }
    in_.finish();
    return workspace;
  }

 private:
  /// Bytes of the shortest patch: two texts, two numbers, five figures, no marks.
  static constexpr std::size_t least_patch = 8 + 8 + 20 + 4;
  static constexpr std::size_t least_mark = 4 + 1 + 8 + 4;

  /// The bytes of the next part, which begins with their number.
  std::span<const std::byte> part(const char* what) {
    const std::uint32_t size = in_.count(1, what);
    return in_.bytes(size);
  }

  void read_programs() {
    const std::uint32_t count = in_.count(4, "programs");
    if (count > most_programs) in_.damaged(" claims ", count, " programs, expected ", most_programs, " at most");
    for (std::uint32_t i = 0; i < count; ++i) {
      auto program = Program::load(part("bytes of a program"));
      if (!program) throw std::move(program).error();
      const std::string& device = program->description().device.name;
      if (i > 0 && device != programs_.front().description().device.name)
        in_.damaged(" holds programs for two devices, `", programs_.front().description().device.name, "` and `",
                    device, "`");
      programs_.push_back(*std::move(program));
    }
  }

  void read_shapes() {
    const std::uint32_t count = in_.count(4, "shapes");
    for (std::uint32_t i = 0; i < count; ++i) {
      Bytes of_shape("a shape", part("bytes of a shape"));
      const ShapeFigures figures = read_shape(of_shape, most_mask_cells - mask_cells_);
      of_shape.finish();
      if (const auto* mask = std::get_if<MaskFigures>(&figures)) mask_cells_ += mask->columns * mask->rows;
      auto shape = shape_of(figures);
      if (!shape) in_.damaged(" has shape ", i, ", which is none: ", shape.error().sentence);
      shapes_.push_back(*std::move(shape));
    }
  }

  WorkspacePatch read_patch() {
    std::string name = in_.text("the name of a patch"), made_of = in_.text("the material of a patch");
    const std::uint32_t program = in_.u32(), shape = in_.u32();
    if (program >= programs_.size()) in_.damaged(" has no program ", program);
    if (shape != no_shape && shape >= shapes_.size()) in_.damaged(" has no shape ", shape);
    PatchOptions options{.at = {in_.finite_f32("the place of a patch"), 0}};
    options.at.y = in_.finite_f32("the place of a patch");
    PatchSize size;
    for (float* side : {&size.width, &size.height, &size.rim}) {
      *side = in_.finite_f32("the size of a patch");
      if (*side < 0 || (side != &size.rim && *side == 0)) in_.damaged(" holds ", *side, " for the size of a patch");
    }
    options.size = size;
    if (shape != no_shape) options.shape = shapes_[shape];
    WorkspacePatch patch{std::move(name), std::move(made_of), programs_[program], options, {}};
    const std::uint32_t marks = in_.count(least_mark, "marks");
    for (std::uint32_t i = 0; i < marks; ++i) patch.marks.push_back(read_mark());
    return patch;
  }

  WorkspaceMark read_mark() {
    WorkspaceMark mark;
    mark.slider = in_.text("the slider of a mark");
    const std::uint8_t flags = in_.u8();
    if (flags > (mark_of_percept | mark_has_low | mark_has_high)) in_.damaged(" has flags ", int{flags}, " of a mark");
    mark.is_percept = (flags & mark_of_percept) != 0;
    const float low = in_.finite_f32("the low end of a mark"), high = in_.finite_f32("the high end of a mark");
    if ((flags & mark_has_low) != 0) mark.low = low;
    if ((flags & mark_has_high) != 0) mark.high = high;
    mark.says = in_.text("the words of a mark");
    return mark;
  }

  Bytes in_;
  std::vector<Program> programs_;
  std::vector<Shape> shapes_;
  std::size_t mask_cells_ = 0;
  std::set<std::string> names_;
};

Error damaged_header(std::string sentence, std::string mend, std::size_t byte) {
  return {.code = Code::damaged_file,
          .sentence = std::move(sentence),
          .mend = std::move(mend),
          .place = {.name = {}, .number = byte}};
}

Result<> check_header(std::span<const std::byte> bytes) {
  const auto same = [](std::uint8_t a, std::byte b) { return a == std::to_integer<std::uint8_t>(b); };
  const bool is_one = bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin(), same);
  if (!is_one)
    return damaged_header("this is no workspace file: its first bytes are not those of a .wws file",
                          "make one with `wale build FILE --workspace NAME -o NAME.wws`", 0);
  if (bytes.size() < header_size)
    return damaged_header("the workspace file is cut short within its header", "copy it again", bytes.size());
  Bytes header("the header", bytes.subspan(magic.size(), header_size - magic.size()));
  const std::uint32_t version = header.u32(), zero = header.u32();
  const std::uint64_t hash = header.u64();
  if (version > workspace_format::version)
    return Error{.code = Code::newer_file,
                 .sentence = "its format is " + std::to_string(version) + ", but this Wale reads only up to " +
                             std::to_string(workspace_format::version),
                 .mend = "update Wale"};
  if (version == 0 || zero != 0 || hash != Fnv1a<std::uint64_t>().take_all(bytes.subspan(header_size)).hash())
    return damaged_header("the workspace file is damaged or cut short", "copy it again", header_size);
  return {};
}

}  // namespace

Result<Workspace> Workspace::load(std::span<const std::byte> bytes) {
  if (auto header = check_header(bytes); !header) return std::move(header).error();
  try {
    return WorkspaceReader(bytes.subspan(header_size)).read();
  } catch (const Error& error) {
    return error;
  }
}

std::vector<std::byte> write_workspace(const Workspace& workspace) {
  Parts programs, shapes;
  ByteWriter patches;
  for (const WorkspacePatch& patch : workspace.patches) {
    const std::uint32_t program = programs.number_of(write_patch_program(patch.program.description()));
    const bool is_rectangle = patch.options.shape.is_rectangle();
    const std::uint32_t shape =
        is_rectangle ? no_shape : shapes.number_of(bytes_of(figures_of(patch.options.shape)).result());
    const PatchSize size = patch.options.size.value_or(PatchSize{});
    patches << std::string_view(patch.name) << std::string_view(patch.made_of) << program << shape << patch.options.at.x
            << patch.options.at.y << size.width << size.height << size.rim
            << static_cast<std::uint32_t>(patch.marks.size());
    for (const WorkspaceMark& mark : patch.marks) write_mark(patches, mark);
  }
  ByteWriter content;
  content << std::string_view(workspace.name) << std::string_view(workspace.documentation);
  programs.write(content);
  shapes.write(content);
  content << static_cast<std::uint32_t>(workspace.patches.size()) << patches.result();
  ByteWriter file;
  file << std::as_bytes(std::span(magic)) << version << std::uint32_t{0}
       << Fnv1a<std::uint64_t>().take_all(content.result()).hash() << content.result();
  return std::move(file.result());
}

}  // namespace wale
