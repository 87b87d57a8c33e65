// What is handed over, and when, while banks are prepared: step by step, without threads.
#include "runtime/stage/patch_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <set>

#include "tests/runtime/figures.hpp"
#include "tests/runtime/programs.hpp"

namespace wale::patch_table_test {
namespace {

using Work = PatchTable::Work;

class Prepared : public testing::Test {
 protected:
  Prepared() { table.begin(PatchTable::Manner::piecewise); }

  PatchName add(const Program& program, float x = 0) {
    WantedPatch placement(program, {x, 0}, program.default_size(), 0);
    placement.order = table.next_order();
    const PatchName name = table.reserve();
    table.want({{name, placement}});
    return name;
  }
  using Change = std::function<void(WantedPatch&)>;
  PatchTable::Wish wish(PatchName name, const Change& change) const {
    WantedPatch placement = *table.wanted(name);
    change(placement);
    return {name, placement};
  }
  static Change set(float value) {
    return [value](WantedPatch& patch) { patch.parameters[0] = value; };
  }
  static Change move(float x) {
    return [x](WantedPatch& patch) { patch.position.x = x; };
  }
  static Change replace(const Program& program) {
    return [program](WantedPatch& patch) { patch.replace(program); };
  }
  void want(PatchName name, const Change& change) { table.want({wish(name, change)}); }
  void remove(PatchName name) { table.want({{name, std::nullopt}}); }

  Work begin() {
    auto work = table.next_work({});
    EXPECT_TRUE(work);
    return *work;
  }
  void finish(Work work) {
    const std::atomic<bool> stop = false;
    EXPECT_TRUE(work.run(banks, stop));
    table.finish(std::move(work), true);
  }
  void finish_all() {
    while (auto work = table.next_work({})) finish(*work);
  }
  void publish() {
    table.publish(patches, nullptr);
    patches.take();
  }
  const PlacedPatch* placed(PatchName name) {
    const PlacedPatch* const patch = patches.held() != nullptr ? patches.held()->patch(name.number) : nullptr;
    return patch != nullptr && patch->generation == name.generation ? patch : nullptr;
  }
  /// The first parameter that the loop has.
  float felt(PatchName name) {
    const PlacedPatch* const patch = placed(name);
    if (patch == nullptr) return -1;
    return patch->bank->bank.registers()[patch->bank->bank.program().description().first_parameter()];
  }
  float place(PatchName name) { return placed(name) != nullptr ? placed(name)->outline.position.x : -1; }

  BankCache banks;
  PatchTable table{banks};
  Exchange<PlacedPatches> patches;
};

TEST_F(Prepared, UntilARunHasAPatchItIsAsTheRunBeforeHadItLast) {
  const PatchName patch = add(push(1), 0.01f), other = add(push(2));
  finish_all();
  EXPECT_EQ(table.felt(patch).as, nullptr);
  EXPECT_EQ(table.felt(patch).before, nullptr);
  publish();
  EXPECT_EQ(table.felt(patch).as->position.x, 0.01f);
  table.end();
  want(patch, move(0.02f));
  for (int run = 0; run < 3; ++run) {  // runs that end before they have it
    table.begin(PatchTable::Manner::piecewise);
    EXPECT_EQ(table.felt(patch).as, nullptr);
    ASSERT_NE(table.felt(patch).before, nullptr);
    EXPECT_EQ(table.felt(patch).before->position.x, 0.01f);
    if (run < 2) table.end();
  }
  finish_all();
  publish();
  EXPECT_EQ(table.felt(patch).as->position.x, 0.02f);
  table.end();
  remove(other);
  const PatchName next = add(push(3));  // in the place of the one that was removed
  EXPECT_EQ(next.number, other.number);
  EXPECT_EQ(table.felt(next).before, nullptr);
}

TEST_F(Prepared, ABankThatIsBegunIsFeltAlthoughANewerOneIsWanted) {
  const PatchName patch = add(push(1));
  finish_all();
  publish();
  EXPECT_EQ(felt(patch), 1);
  for (const float value : {2.0f, 3.0f, 4.0f}) {  // each is replaced while its bank is prepared
    want(patch, set(value));
    const Work work = begin();
    want(patch, set(value + 0.25f));
    want(patch, set(value + 0.5f));
    publish();
    const float before = felt(patch);
    finish(work);
    publish();
    EXPECT_NE(felt(patch), before);
    EXPECT_EQ(felt(patch), value);
  }
  finish_all();
  publish();
  EXPECT_EQ(felt(patch), 4.5f);
  // Never an older one after a newer one.
  want(patch, set(5));
  const Work work = begin();
  want(patch, set(4));  // its bank is known
  publish();
  EXPECT_EQ(felt(patch), 4);
  want(patch, set(4.75f));
  finish(work);
  publish();
  EXPECT_EQ(felt(patch), 4);
  finish_all();
  publish();
  EXPECT_EQ(felt(patch), 4.75f);
}

TEST_F(Prepared, EachPatchOfAStreamHasItsTurn) {
  std::vector<PatchName> all;
  for (int i = 0; i < 10; ++i) all.push_back(add(push(1), 0.5f));
  finish_all();
  publish();
  std::set<std::uint32_t> changed;
  for (int turn = 1; turn <= 12; ++turn) {
    for (const PatchName each : all) want(each, set(1 + 0.1f * static_cast<float>(turn) + 0.001f * float(each.number)));
    for (int i = 0; i < 2; ++i) finish(begin());  // there is no time for more
    publish();
    for (const PatchName each : all)
      if (felt(each) != 1) changed.insert(each.number);
  }
  EXPECT_EQ(changed.size(), all.size());
}

/// Ranges that a bank ends early come at last, and so does a new base.
TEST_F(Prepared, BoundsAndBasesComeAtLastUnderAnEndlessStream) {
  const PatchName touched = add(corduroy(1.934f)), still = add(corduroy(1.5f), 0.5f);
  finish(begin());
  publish();
  const Program one = push(1);
  for (int i = 0; i < 600; ++i) add(one, 0.3f + 0.0001f * static_cast<float>(i));
  bool based = false;
  int turns = 0;
  const auto is_bounded = [&](PatchName name) {
    const PlacedPatch* const patch = placed(name);
    return patch != nullptr && patch->potential_range < trivial_potential_range(patch->bank->bank);
  };
  for (; turns < 200 && !(based && is_bounded(still)); ++turns) {
    want(touched, set(0.001f + 1e-6f * static_cast<float>(turns)));
    for (int works = 0; works < 2; ++works) {
      auto work = table.next_work({});
      if (!work) continue;
      based = based || work->kind == Work::Kind::base;
      if (work->kind == Work::Kind::range && work->may_stop)
        table.finish(*work, false);  // the next change ends it
      else
        finish(*work);
    }
    publish();
  }
  EXPECT_TRUE(based);
  EXPECT_TRUE(is_bounded(still)) << turns;
  EXPECT_FALSE(is_bounded(touched));
  finish_all();
  publish();
  EXPECT_TRUE(is_bounded(touched)) << "when the stream has ended";
}

TEST_F(Prepared, APatchMayBeRemovedWhileItsBankIsPrepared) {
  const PatchName patch = add(push(1)), never_felt = add(push(2));
  Work first = begin();
  remove(patch);
  remove(never_felt);
  finish(first);
  publish();
  EXPECT_EQ(placed(patch), nullptr);
  EXPECT_FALSE(table.is_waiting()) << "nobody wants the other bank";
  const PatchName other = add(push(1));
  finish_all();
  publish();
  EXPECT_EQ(felt(other), 1);
  want(other, set(3));
  const Work work = begin();
  remove(other);
  publish();
  EXPECT_EQ(placed(other), nullptr) << "at once";
  const PatchName next = add(oil(1));  // in the same slot
  EXPECT_EQ(next.number, other.number);
  finish(work);
  publish();
  EXPECT_EQ(placed(next), nullptr) << "another patch's bank is not its own";
  finish_all();
  publish();
  ASSERT_NE(placed(next), nullptr);
  EXPECT_EQ(&placed(next)->bank->bank.program().decoded(), &table.wanted(next)->program.decoded());
}

TEST_F(Prepared, APatchMayBeReplacedWhileItsBankIsPrepared) {
  const PatchName patch = add(push(1));
  finish_all();
  publish();
  const std::shared_ptr<Memory> memory = placed(patch)->memory;
  want(patch, set(2));
  const Work work = begin();
  const Program other = bead(200);
  want(patch, replace(other));
  finish(work);
  publish();
  EXPECT_EQ(felt(patch), 2);
  EXPECT_EQ(placed(patch)->memory, memory);
  finish_all();
  publish();
  EXPECT_EQ(&placed(patch)->bank->bank.program().decoded(), &other.decoded());
  EXPECT_EQ(&placed(patch)->memory->program().decoded(), &other.decoded());
  EXPECT_TRUE(placed(patch)->memory->follows(memory.get()));
  want(patch, replace(push(3)));
  Work late = begin();
  table.end();  // the run is over
  table.finish(std::move(late), false);
  table.begin(PatchTable::Manner::piecewise);
  finish_all();
  publish();
  EXPECT_EQ(felt(patch), 3);
}

TEST_F(Prepared, APatchThatNobodyTouchesIsReplacedWithoutEnd) {
  const PatchName patch = add(push(1));
  for (int i = 0; i < 1000; ++i) {
    want(patch, replace(push(1)));
    finish_all();
    publish();
    ASSERT_LE(placed(patch)->memory->predecessors(), 64u);
  }
}

TEST_F(Prepared, AnEditIsHandedOverAsAWhole) {
  const PatchName a = add(push(1)), b = add(push(1)), c = add(push(1));
  finish_all();
  publish();
  // A later edit of one of its patches waits until then, also one that removes it.
  table.want({wish(a, set(2)), wish(b, move(0.1f))});
  table.want({{b, std::nullopt}, wish(c, move(0.2f))});
  publish();
  EXPECT_NE(placed(b), nullptr);
  EXPECT_EQ(place(c), 0);
  EXPECT_EQ(table.wanted(b), nullptr) << "but it is gone for its callers";
  EXPECT_EQ(table.size(), 2u);
  EXPECT_EQ(table.wanted(c)->position.x, 0.2f);
  finish_all();
  publish();
  EXPECT_EQ(felt(a), 2);
  EXPECT_EQ(place(b), 0.1f);
  EXPECT_EQ(place(c), 0);
  EXPECT_TRUE(table.has_news());
  publish();
  EXPECT_EQ(placed(b), nullptr);
  EXPECT_EQ(place(c), 0.2f);
  // A newer change of one patch, before the edit is handed over and while its bank is prepared.
  table.want({wish(a, set(3)), wish(c, move(0.3f))});
  finish_all();
  want(a, set(3.5f));
  publish();
  EXPECT_EQ(felt(a), 3);
  EXPECT_EQ(place(c), 0.3f);
  table.want({wish(a, set(4)), wish(c, move(0.4f))});
  const Work work = begin();
  want(a, set(4.5f));
  publish();
  EXPECT_EQ(felt(a), 3);
  EXPECT_EQ(place(c), 0.3f);
  finish(work);
  publish();
  EXPECT_EQ(felt(a), 4);
  EXPECT_EQ(place(c), 0.4f);
  // A bank that was begun before the edit is not the edit's.
  want(a, set(5));
  const Work before = begin();
  table.want({wish(a, set(5.5f)), wish(c, move(0.5f))});
  finish(before);
  publish();
  EXPECT_EQ(felt(a), 4);
  EXPECT_EQ(place(c), 0.4f);
  finish_all();
  publish();
  EXPECT_EQ(felt(a), 5.5f);
  EXPECT_EQ(place(c), 0.5f);
  // One edit is ready, and another one takes its patch before it is handed over.
  table.want({wish(a, move(0.1f)), wish(c, move(0.6f))});
  table.want({wish(a, set(6)), wish(c, set(7))});
  publish();
  EXPECT_EQ(place(a), 0.1f);
  EXPECT_EQ(place(c), 0.6f);
  EXPECT_EQ(felt(a), 5.5f);
  finish_all();
  publish();
  EXPECT_EQ(felt(a), 6);
  EXPECT_EQ(felt(c), 7);
}

/// Each edit comes before the banks of the one before are ready.
TEST_F(Prepared, AnEndlessStreamOfEditsIsFelt) {
  const PatchName a = add(push(1)), b = add(push(1)), c = add(push(1));
  finish_all();
  publish();
  std::set<float> values;
  for (int turn = 1; turn <= 60; ++turn) {
    const float value = 1 + 0.1f * static_cast<float>(turn);
    table.want({wish(a, set(value)), wish(b, set(value)), wish(c, move(value))});
    if (auto work = table.next_work({})) finish(*work);
    publish();
    EXPECT_EQ(felt(a), felt(b));
    if (felt(a) != 1) {
      EXPECT_EQ(felt(a), place(c));
    }
    values.insert(felt(a));
  }
  EXPECT_GT(values.size(), 15u);
}

/// Numbers its changes: each writes its number into a place or a parameter of some patches.
TEST_F(Prepared, OfRandomChangesEachEditIsWholeAndNothingGoesBack) {
  std::mt19937 random(1995);
  std::vector<PatchName> all;
  for (int i = 0; i < 6; ++i) all.push_back(add(push(0)));
  finish_all();
  publish();
  using Value = std::pair<std::size_t, bool>;  // which patch; its parameter, or its place
  std::vector<std::vector<Value>> changes{{}};
  std::map<Value, std::size_t> before;
  std::vector<Work> under_way;
  const auto number_in = [&](Value value) {
    const PatchName name = all[value.first];
    return static_cast<std::size_t>(std::lround(1000 * (value.second ? felt(name) : place(name))));
  };
  for (int turn = 0; turn < 4000; ++turn) {
    std::vector<PatchTable::Wish> wishes;
    std::vector<Value> values;
    const float number = 0.001f * static_cast<float>(changes.size());
    for (std::size_t patch = 0; patch < all.size(); ++patch) {
      if (random() % 4 != 0) continue;
      values.push_back({patch, random() % 2 == 0});
      wishes.push_back(wish(all[patch], values.back().second ? set(number) : move(number)));
    }
    if (!wishes.empty()) {
      changes.push_back(values);
      table.want(std::move(wishes));
    }
    if (random() % 3 == 0 && under_way.empty())
      if (auto work = table.next_work({})) under_way.push_back(*work);
    if (random() % 3 == 0 && !under_way.empty()) {
      finish(under_way.back());
      under_way.pop_back();
    }
    if (random() % 2 == 0) publish();
    std::map<Value, std::size_t> now;
    for (std::size_t patch = 0; patch < all.size(); ++patch)
      for (const bool parameter : {false, true}) now[{patch, parameter}] = number_in({patch, parameter});
    for (const auto& [value, change] : now) {
      ASSERT_GE(change, before[value]) << turn;
      for (const Value& other : changes[change]) ASSERT_GE(now[other], change) << turn;
    }
    before = now;
  }
  EXPECT_GT(before.begin()->second, 1000u) << "something is felt all the time";
  for (Work& work : under_way) finish(work);
  for (int i = 0; i < 3; ++i) {
    finish_all();
    publish();
  }
  for (const PatchName each : all) {
    EXPECT_EQ(felt(each), table.wanted(each)->parameters[0]);
    EXPECT_EQ(place(each), table.wanted(each)->position.x);
  }
}

TEST_F(Prepared, WhatALaterEditAddsAndRemovesLeavesNoTrace) {
  const PatchName a = add(push(1));
  finish_all();
  publish();
  for (const bool ended : {false, true}) {
    const PatchName b = add(push(2));
    table.want({wish(a, set(ended ? 3 : 4)), wish(b, move(1))});
    WantedPatch placement(push(5), {0, 0}, push(5).default_size(), 0);
    const PatchName added = table.reserve();
    table.want({wish(a, move(0.1f)), {added, placement}});
    EXPECT_NE(table.wanted(added), nullptr);
    EXPECT_EQ(table.size(), 3u);
    remove(added);
    remove(b);
    EXPECT_EQ(table.wanted(added), nullptr);
    if (ended) {
      table.end();
      table.begin(PatchTable::Manner::piecewise);
    }
    finish_all();
    publish();
    publish();
    EXPECT_EQ(table.size(), 1u);
    EXPECT_EQ(felt(a), ended ? 3 : 4);
    EXPECT_EQ(place(a), 0.1f);
    EXPECT_EQ(placed(added), nullptr);
    EXPECT_EQ(placed(b), nullptr);
    const PatchName next = table.reserve();
    EXPECT_LT(next.number, 3u) << "the slots are used again";
    table.release(next);
  }
}

}  // namespace
}  // namespace wale::patch_table_test
