#include "feeling/programs.hpp"

#include <cctype>
#include <functional>

namespace sandpaper {
namespace {

constexpr const char* patch_material = "patch_of_the_workspace";
constexpr std::size_t longest_name = 60;

/// What a recording and an exported program call the material of a patch: "denim" of `denim(roughness: 0.3)`,
/// "wet_glass" of `"wet glass"`, "n0_5_oak_0_5_denim" of a mixture.
std::string material_name(const std::string& made_of) {
  std::string name;
  for (const char letter : made_of.substr(0, made_of.find('(')))
    if (std::isalnum(static_cast<unsigned char>(letter))) name += letter;
    else if (!name.empty() && name.back() != '_') name += '_';
  while (!name.empty() && name.back() == '_') name.pop_back();
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name.front()))) name = "n" + name;
  return name.substr(0, longest_name);
}

}  // namespace

Programs::Programs(const wale::LanguageService& language, QObject* parent) : QObject(parent), language_(language) {}
Programs::~Programs() = default;

void Programs::set_device(const std::string& device) {
  if (device == device_) return;
  device_ = device;
  known_.clear();
  ++generation_;
}

MaterialProgramRef Programs::find(const std::string& surroundings, const std::string& file, const std::string& made_of,
                                  int urgency) {
  const std::string key = std::to_string(std::hash<std::string>()(surroundings)) + "|" + file + "|" + made_of;
  const auto [found, is_new] = known_.try_emplace(key);
  if (!is_new) return found->second;
  const std::string text = surroundings + "\nmaterial " + patch_material + " = " + made_of + "\n";
  const wale::CompileOptions options{
      .device = device_, .material = patch_material, .name = file.empty() ? "untitled.wale" : file};
  thread_.post(urgency, key, [this, key, made_of, text, options, generation = generation_] {
    wale::CompiledText compiled = language_.compile(text, options, material_name(made_of));
    auto program = std::make_shared<MaterialProgram>();
    program->program = std::move(compiled.program), program->problems = std::move(compiled.problems);
    window_.post([this, key, made_of, program, generation] { keep(key, made_of, program, generation); });
  });
  return nullptr;
}

void Programs::keep(const std::string& key, const std::string& made_of, MaterialProgramRef program,
                    std::uint64_t generation) {
  if (generation != generation_) return;
  known_[key] = std::move(program);
  emit compiled(QString::fromStdString(made_of));
}

}  // namespace sandpaper
