#include <string>
#include <utility>

#include "runtime/c/sized.hpp"
#include "runtime/c/stage.hpp"

struct WaleEdit {
  wale::StageEdit edit;
};

namespace wale::c {
namespace {

/// Calls `change` with the patch of a handle.
template <class Change>
WaleCode change_patch(WalePatch* patch, WaleError** error, const Change& change) {
  return call(error, [&]() -> Result<> {
    if (auto given = is_given("patch", patch); !given) return given;
    return change(patch->patch);
  });
}

/// A call of an edit. What fails makes the edit's commit fail: an edit is made as a whole, also for whoever looks at the
/// result of its commit only.
template <class Body>
WaleCode call_of_edit(WaleEdit* edit, WaleError** error, const Body& body) {
  return call(error, [&]() -> Result<> {
    if (auto given = is_given("edit", edit); !given) return given;
    try {
      Result<> done = body();
      if (!done) edit->edit.fail(done.error());
      return done;
    } catch (...) {
      edit->edit.fail({.code = Code::short_of_resources});  // needs no memory; the commit says it in words
      throw;
    }
  });
}

/// A text of one line, `otherwise` if it is empty.
Result<std::string> read_line(const char* argument, WaleText text, const char* otherwise) {
  auto read = read_text(argument, text);
  if (!read || !read->empty()) return read ? read_name(argument, text, "write one line", "a line") : std::move(read);
  return std::string(otherwise);
}

/// Calls `change` with an edit and a patch.
template <class Change>
WaleCode change_edit(WaleEdit* edit, const WalePatch* patch, WaleError** error, const Change& change) {
  return call_of_edit(edit, error, [&]() -> Result<> {
    if (auto given = is_given("patch", patch); !given) return given;
    return change(edit->edit, patch->patch);
  });
}

}  // namespace
}  // namespace wale::c

using namespace wale::c;

WaleCode wale_patch_set(WalePatch* patch, WaleText parameter, double value, WaleError** error) {
  return change_patch(patch, error, [&](wale::Patch& each) -> wale::Result<> {
    const auto name = read_text("parameter", parameter);
    return name ? each.set(*name, value) : name.error();
  });
}

WaleCode wale_patch_move(WalePatch* patch, float x, float y, WaleError** error) {
  return change_patch(patch, error, [&](wale::Patch& each) { return each.move({x, y}); });
}

WaleCode wale_patch_resize(WalePatch* patch, float width, float height, float rim, WaleError** error) {
  return change_patch(patch, error, [&](wale::Patch& each) { return each.resize({width, height, rim}); });
}

WaleCode wale_patch_replace(WalePatch* patch, const WaleProgram* program, WaleError** error) {
  return change_patch(patch, error, [&](wale::Patch& each) -> wale::Result<> {
    const auto known = read_program(program);
    return known ? each.replace(**known) : known.error();
  });
}

WaleCode wale_patch_enable(WalePatch* patch, int32_t enabled, WaleError** error) {
  return change_patch(patch, error, [&](wale::Patch& each) -> wale::Result<> {
    const auto wanted = read_flag("enabled", enabled);
    return wanted ? each.enable(*wanted) : wanted.error();
  });
}

WaleCode wale_patch_bring(WalePatch* patch, float layer, WaleError** error) {
  return change_patch(patch, error, [&](wale::Patch& each) { return each.bring({.layer = layer}); });
}

WaleCode wale_patch_remove(WalePatch* patch, WaleError** error) {
  return change_patch(patch, error, [&](wale::Patch& each) { return each.remove(); });
}

int32_t wale_patch_exists(const WalePatch* patch) { return patch != nullptr && patch->patch.exists(); }

uint64_t wale_patch_id(const WalePatch* patch) { return patch == nullptr ? 0 : patch->patch.id(); }

uint32_t wale_patch_number(const WalePatch* patch) { return patch == nullptr ? 0xffffffffu : patch->patch.number(); }

void wale_patch_free(WalePatch* patch) { free_handle(patch); }

WaleCode wale_stage_edit(WaleStage* stage, WaleEdit** edit, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("edit", edit); !clear) return clear;
    if (auto given = is_stage_here(stage); !given) return given;
    hand_out(std::make_unique<WaleEdit>(WaleEdit{stage->stage.edit()}), edit);
    return {};
  });
}

WaleCode wale_edit_add(WaleEdit* edit, const WaleProgram* program, const WalePatchOptions* options, WalePatch** patch,
                       WaleError** error) {
  if (patch != nullptr) *patch = nullptr;
  return call_of_edit(edit, error, [&]() -> wale::Result<> {
    const auto known = read_program(program);
    if (!known) return known.error();
    const auto read = read_options(options);
    if (!read) return read.error();
    HandleToBe<WalePatch> handle(patch);
    auto added = edit->edit.add(**known, *read);
    if (!added) return std::move(added).error();
    if (handle) handle->patch = *std::move(added);
    handle.give();
    return {};
  });
}

WaleCode wale_edit_set(WaleEdit* edit, const WalePatch* patch, WaleText parameter, double value, WaleError** error) {
  return change_edit(edit, patch, error, [&](wale::StageEdit& to, const wale::Patch& each) -> wale::Result<> {
    const auto name = read_text("parameter", parameter);
    if (!name) return name.error();
    to.set(each, *name, value);
    return {};
  });
}

WaleCode wale_edit_move(WaleEdit* edit, const WalePatch* patch, float x, float y, WaleError** error) {
  return change_edit(edit, patch, error, [&](wale::StageEdit& to, const wale::Patch& each) -> wale::Result<> {
    to.move(each, {x, y});
    return {};
  });
}

WaleCode wale_edit_resize(WaleEdit* edit, const WalePatch* patch, float width, float height, float rim,
                          WaleError** error) {
  return change_edit(edit, patch, error, [&](wale::StageEdit& to, const wale::Patch& each) -> wale::Result<> {
    to.resize(each, {width, height, rim});
    return {};
  });
}

WaleCode wale_edit_replace(WaleEdit* edit, const WalePatch* patch, const WaleProgram* program, WaleError** error) {
  return change_edit(edit, patch, error, [&](wale::StageEdit& to, const wale::Patch& each) -> wale::Result<> {
    const auto known = read_program(program);
    if (!known) return known.error();
    to.replace(each, **known);
    return {};
  });
}

WaleCode wale_edit_enable(WaleEdit* edit, const WalePatch* patch, int32_t enabled, WaleError** error) {
  return change_edit(edit, patch, error, [&](wale::StageEdit& to, const wale::Patch& each) -> wale::Result<> {
    const auto wanted = read_flag("enabled", enabled);
    if (!wanted) return wanted.error();
    to.enable(each, *wanted);
    return {};
  });
}

WaleCode wale_edit_bring(WaleEdit* edit, const WalePatch* patch, float layer, WaleError** error) {
  return change_edit(edit, patch, error, [&](wale::StageEdit& to, const wale::Patch& each) -> wale::Result<> {
    to.bring(each, {.layer = layer});
    return {};
  });
}

WaleCode wale_edit_remove(WaleEdit* edit, const WalePatch* patch, WaleError** error) {
  return change_edit(edit, patch, error, [&](wale::StageEdit& to, const wale::Patch& each) -> wale::Result<> {
    to.remove(each);
    return {};
  });
}

WaleCode wale_edit_fail(WaleEdit* edit, WaleCode code, WaleText argument, WaleText sentence, WaleText mend,
                        WaleError** error) {
  return call_of_edit(edit, error, [&]() -> wale::Result<> {
    const auto known = static_cast<wale::Code>(code);
    if (code <= 0 || wale::code_title(known).empty() || wale::severity_of(known) != wale::Severity::error)
      return about_argument("code", "expected the code of an error, found " + std::to_string(code),
                            "take WALE_CODE_malformed_value, or another one that fits");
    auto what = read_name("sentence", sentence, "say in a line what is wrong", "a sentence");
    if (!what) return std::move(what).error();
    auto name = read_line("argument", argument, "edit");
    if (!name) return std::move(name).error();
    auto how = read_line("mend", mend, "make the edit without this change");
    if (!how) return std::move(how).error();
    edit->edit.fail({.code = known,
                     .sentence = *std::move(what),
                     .mend = *std::move(how),
                     .place = {.name = *std::move(name)}});
    return {};
  });
}

WaleCode wale_edit_commit(WaleEdit* edit, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("edit", edit); !given) return given;
    return edit->edit.commit();
  });
}

void wale_edit_free(WaleEdit* edit) { free_handle(edit); }
