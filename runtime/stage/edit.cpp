#include <algorithm>
#include <exception>
#include <utility>
#include <vector>

#include "runtime/stage/stage_state.hpp"

namespace wale {
namespace {

Error no_memory_for_a_call() {
  return {.code = Code::short_of_resources,
          .sentence = "there was no memory left for one of the edit's calls",
          .mend = "free some, and make the whole edit again",
          .place = {.name = "edit"}};
}

Error is_removed_before() {
  return wrong_moment("patch", "an earlier call of the edit removes the patch",
                      "leave out the removal, or make it the last of the patch's changes");
}

Error edit_was_moved() { return wrong_moment("edit", "the edit was moved from", "use the edit that it was moved to"); }

}  // namespace

struct StageEdit::Parts {
  /// A change of a patch; an empty one removes it.
  struct Step {
    PatchName name;
    StageState::Change change;
  };

  std::weak_ptr<StageState> stage;
  std::vector<std::pair<PatchName, WantedPatch>> added;
  std::vector<Step> steps;
  std::optional<Error> error;  // the first that a call found; without a sentence where there was no memory for one
  std::size_t before_error = 0;  // so many steps were called before it; one of them may still be found to fail

  ~Parts() { discard(); }

  void discard() {
    const auto state = stage.lock();
    if (state && state->home.is_here()) {
      const std::lock_guard lock(state->mutex);
      for (const auto& [name, placement] : added) state->table.release(name);
    }
    added.clear();
    steps.clear();
    error.reset();
  }
  void fail(Error why) noexcept {
    if (error) return;
    error.emplace(std::move(why));
    before_error = steps.size();
  }
  /// While one exists, an exception (there is no memory) makes the edit fail as a whole, as an error does: the call that
  /// it ends has changed nothing, so a commit of the others would be half of what was asked for.
  class WholeOrNot {
   public:
    explicit WholeOrNot(Parts& parts) noexcept : parts_(parts), thrown_(std::uncaught_exceptions()) {}
    [[gnu::noinline]] ~WholeOrNot() {
      if (std::uncaught_exceptions() > thrown_) parts_.fail(Error{.code = Code::short_of_resources});
    }
    WholeOrNot(const WholeOrNot&) = delete;
    WholeOrNot& operator=(const WholeOrNot&) = delete;

   private:
    Parts& parts_;
    int thrown_;
  };

  void step(const std::weak_ptr<StageState>& of, PatchName name, StageState::Change change) {
    const bool other = of.owner_before(stage) || stage.owner_before(of);
    if (other)
      return fail(wrong_moment("patch", "the patch is not on the edit's stage",
                               "begin an edit of the patch's own stage"));
    steps.push_back({name, std::move(change)});
  }
};

StageEdit::StageEdit(std::weak_ptr<StageState> stage) : parts_(std::make_unique<Parts>()) {
  parts_->stage = std::move(stage);
}
StageEdit::StageEdit(StageEdit&&) noexcept = default;
StageEdit& StageEdit::operator=(StageEdit&&) noexcept = default;
StageEdit::~StageEdit() = default;

Result<Patch> StageEdit::add(const Program& program, const PatchOptions& options) {
  if (!parts_) return edit_was_moved();
  const Parts::WholeOrNot whole(*parts_);
  const auto found = here(parts_->stage.lock(), stage_is_gone);
  if (!found) return found.error();
  const auto& state = *found;
  Result<WantedPatch> placement = state->wanted(program, options);
  if (!placement) {
    parts_->fail(placement.error());
    return std::move(placement).error();
  }
  const std::lock_guard lock(state->mutex);
  parts_->added.emplace_back(PatchName(), *std::move(placement));
  PatchName& name = parts_->added.back().first;
  try {
    name = state->table.reserve();
  } catch (...) {
    parts_->added.pop_back();
    throw;
  }
  return Patch(parts_->stage, name.number, name.generation);
}

void StageEdit::set(const Patch& patch, std::string_view parameter, double value) {
  if (!parts_) return;
  const Parts::WholeOrNot whole(*parts_);
  parts_->step(patch.stage_, StageState::name_of(patch), changes::set(std::string(parameter), value));
}

void StageEdit::move(const Patch& patch, glm::vec2 to) {
  if (!parts_) return;
  const Parts::WholeOrNot whole(*parts_);
  parts_->step(patch.stage_, StageState::name_of(patch), changes::move(to));
}

void StageEdit::resize(const Patch& patch, PatchSize size) {
  if (!parts_) return;
  const Parts::WholeOrNot whole(*parts_);
  parts_->step(patch.stage_, StageState::name_of(patch), changes::resize(size));
}

void StageEdit::replace(const Patch& patch, const Program& program) {
  const auto state = parts_ ? parts_->stage.lock() : nullptr;
  if (!state) return;
  const Parts::WholeOrNot whole(*parts_);
  parts_->step(patch.stage_, StageState::name_of(patch), changes::replace(program, *state));
}

void StageEdit::enable(const Patch& patch, bool enabled) {
  if (!parts_) return;
  const Parts::WholeOrNot whole(*parts_);
  parts_->step(patch.stage_, StageState::name_of(patch), changes::enable(enabled));
}

void StageEdit::bring(const Patch& patch, const BringOptions& to) {
  const auto state = parts_ ? parts_->stage.lock() : nullptr;
  if (!state) return;
  const Parts::WholeOrNot whole(*parts_);
  parts_->step(patch.stage_, StageState::name_of(patch), changes::bring(to.layer, state->table));
}

void StageEdit::remove(const Patch& patch) {
  if (!parts_) return;
  const Parts::WholeOrNot whole(*parts_);
  parts_->step(patch.stage_, StageState::name_of(patch), StageState::Change());
}

void StageEdit::fail(Error error) {
  if (!parts_) return;
  const Parts::WholeOrNot whole(*parts_);
  const bool is_error = !code_title(error.code).empty() && severity_of(error.code) == Severity::error;
  if (!is_error)
    error = malformed("code", "expected the code of an error", "take Code::malformed_value, or another one that fits",
                      "the code of an error", code_name(error.code));
  else if (error.code != Code::short_of_resources && error.sentence.find_first_not_of(" \t\r\n") == std::string::npos)
    error = malformed("sentence", "expected a sentence, found an empty text", "say in a line what is wrong", "a sentence",
                      "an empty text");
  parts_->fail(std::move(error));
}

Result<> StageEdit::commit() {
  if (!parts_) return edit_was_moved();
  const auto found = here(parts_->stage.lock(), stage_is_gone);
  if (!found) return found.error();
  const auto& state = *found;
  const auto refuse = [&](Error error) -> Result<> {
    parts_->discard();
    return error;
  };
  const auto refuse_as_called = [&] {
    return refuse(parts_->error->sentence.empty() ? no_memory_for_a_call() : *parts_->error);
  };
  if (parts_->error && parts_->before_error == 0) return refuse_as_called();
  std::unique_lock lock(state->mutex);
  if (state->over) return stage_is_gone();
  std::vector<PatchTable::Wish> wishes;
  std::unordered_map<std::uint32_t, std::size_t> known;  // by the patch's number: its wish
  for (auto& [name, placement] : parts_->added) {
    placement.order = state->table.next_order();
    known.emplace(name.number, wishes.size());
    wishes.emplace_back(name, placement);
  }
  for (std::size_t i = 0; i < parts_->steps.size(); ++i) {
    if (parts_->error && i == parts_->before_error) break;
    const Parts::Step& step = parts_->steps[i];
    const auto [place, is_new] = known.try_emplace(step.name.number, wishes.size());
    if (is_new) {
      const auto there = state->has(step.name);
      if (there) wishes.emplace_back(step.name, *state->table.wanted(step.name));
      if (!there) {
        lock.unlock();
        return refuse(there.error());
      }
    }
    auto& [name, wish] = wishes[place->second];
    Result<> done;
    if (!(name == step.name))
      done = patch_is_gone();
    else if (!wish)
      done = is_removed_before();
    else if (!step.change)
      wish.reset();
    else
      done = step.change(*wish);
    if (!done) {
      lock.unlock();
      return refuse(std::move(done).error());
    }
  }
  if (parts_->error) {
    lock.unlock();
    return refuse_as_called();
  }
  // A patch that was added and removed again was never there.
  std::erase_if(wishes, [&](const PatchTable::Wish& wish) {
    return !wish.second && state->table.wanted(wish.first) == nullptr;
  });
  state->want(std::move(wishes));  // what may throw; all else comes after it
  for (const auto& [name, placement] : parts_->added) state->table.release(name);  // of those that were never there
  parts_->added.clear();
  parts_->steps.clear();
  return {};
}

}  // namespace wale
