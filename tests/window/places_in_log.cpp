// Where patches and keys lie is in the log of a session, whoever moves them.
#include <cmath>
#include <map>

#include "presented_window.hpp"

namespace sandpaper {
namespace {

TEST_F(PresentedWindow, WhereverPatchesAreMovedIsOnTheDiskBeforeWhatComesNext) {
  begin_session();
  const auto placed_lines = [&] { return all_of<wale::SessionPlaced>(log()); };
  const auto last_line = [&] {
    const auto all = placed_lines();
    return all.empty() ? wale::SessionPlaced() : all.back();
  };
  const auto last_item = [&] {
    const auto items = last_line().items;
    return items.empty() ? wale::SessionPlace() : items.back();
  };
  ASSERT_TRUE(wait_until([&] { return placed_lines().size() == 1; }, 2000)) << "where all lies at first";
  const auto first = placed_lines().front();
  EXPECT_EQ(first.what, "patches");
  EXPECT_EQ(first.of, "table");
  ASSERT_EQ(first.items.size(), 4u);
  EXPECT_EQ(first.items[1].name, "oak_two");
  EXPECT_NEAR(first.items[1].at.x, 0.05, 1e-9);
  EXPECT_EQ(first.items[1].size, glm::dvec2(0.04, 0.04));
  EXPECT_EQ(first.items[1].layer, 2u);
  // By mouse.
  drag(pixels(-50, 40), pixels(-20, 30));
  ASSERT_TRUE(wait_until([&] { return last_item().at == placed("oak_one").patch.at; }, 2000));
  EXPECT_NEAR(placed("oak_one").patch.at.x, -0.02, 0.0011);
  ASSERT_EQ(last_line().items.size(), 1u) << "only what has moved";
  EXPECT_EQ(last_line().items.front().name, "oak_one");
  // By keyboard, and at once to the next frame: its line stands before the frame's.
  QTest::keyClick(&canvas(), Qt::Key_Right, Qt::ShiftModifier);
  const glm::dvec2 nudged = placed("oak_one").patch.at;
  trigger("next_frame");
  const auto whole = log();
  std::ptrdiff_t moved = -1, shown = -1;
  for (std::size_t i = 0; i < whole.entries.size(); ++i) {
    const auto* place = std::get_if<wale::SessionPlaced>(&whole.entries[i].event);
    if (place && place->of == "table" && place->items.back().at == nudged) moved = static_cast<std::ptrdiff_t>(i);
    const auto* frame = std::get_if<wale::SessionShown>(&whole.entries[i].event);
    if (frame && frame->name == "second") shown = static_cast<std::ptrdiff_t>(i);
  }
  EXPECT_GE(moved, 0);
  EXPECT_GT(shown, moved);
  trigger("previous_frame");
  // A new patch has a number in the log, too; one that is raised has another layer; one that is deleted is gone.
  drop("oak", 0, 0);
  const std::string fresh = contents().placed.back()->patch.name;
  ASSERT_TRUE(wait_until([&] { return last_item().name == fresh; }, 2000));
  const auto numbers = all_of<wale::SessionOrder>(log()).back();
  EXPECT_EQ(numbers.what, "numbers");
  ASSERT_EQ(numbers.items.size(), 1u);
  EXPECT_EQ(numbers.items.front().name, fresh);
  window->document().choose({placed("oak_four").id});
  canvas().setFocus();
  trigger("raise");
  ASSERT_TRUE(wait_until([&] { return last_line().items.size() == 2; }, 2000)) << "both that changed places";
  trigger("delete");
  ASSERT_TRUE(wait_until([&] { return last_line().gone == std::vector<std::string>{"oak_four"}; }, 2000));
  trigger("undo");
  ASSERT_TRUE(wait_until([&] { return last_item().name == "oak_four"; }, 2000));
  // Together the lines tell how all lies now.
  std::map<std::string, wale::SessionPlace> told;
  for (const wale::SessionPlaced& each : placed_lines()) {
    if (each.of != "table") continue;
    for (const std::string& name : each.gone) told.erase(name);
    for (const wale::SessionPlace& item : each.items) told[item.name] = item;
  }
  ASSERT_EQ(told.size(), contents().placed.size());
  for (std::size_t i = 0; i < contents().placed.size(); ++i) {
    const wale::LaidOutPatch& patch = contents().placed[i]->patch;
    EXPECT_NEAR(told.at(patch.name).at.x, patch.at.x, 1e-9) << patch.name;
    EXPECT_EQ(told.at(patch.name).layer, i + 1) << patch.name;
  }
  EXPECT_TRUE(log().problems.empty());
}

TEST_F(PresentedWindow, AnotherFileIsNotInTheLogOfThisOne) {
  begin_session();
  const QString path = session().path();
  ASSERT_TRUE(window->open(write("other.wale", "wale 1\n\nworkspace elsewhere { patch p = oak { at 0 mm, 0 mm } }\n")));
  EXPECT_FALSE(session().runs());
  EXPECT_EQ(read(path).find("elsewhere"), std::string::npos) << read(path);
  EXPECT_NE(read(path).find("another file was opened"), std::string::npos);
}

TEST_F(PresentedWindow, WhereKeysAreLaidIsInTheLog) {
  begin_session();
  start_sorting();
  const auto key_places = [&] {
    std::map<std::string, glm::dvec2> places;
    for (const wale::SessionPlaced& each : all_of<wale::SessionPlaced>(log()))
      if (each.what == "keys" && each.of == "sorting")
        for (const wale::SessionPlace& item : each.items) places[item.name] = item.at;
    return places;
  };
  const auto is_told = [&] {
    const auto places = key_places();
    return places.size() == 4 && std::ranges::all_of(sorting().keys(), [&](const SortingKey& each) {
             return std::abs(places.at(each.name).x - each.at.x) < 1e-9 &&
                    std::abs(places.at(each.name).y - each.at.y) < 1e-9;
           });
  };
  EXPECT_TRUE(wait_until(is_told, 2000));
  // Onto free ground, by mouse: it is in no pile, and its place may be an answer all the same.
  const glm::dvec2 before = sorting().keys()[0].at;
  drag_key(0, QPoint(table().width() / 2 + 20, 40));
  EXPECT_NE(sorting().keys()[0].at, before);
  EXPECT_TRUE(wait_until(is_told, 2000));
  // Into piles by keyboard, which lay themselves out, and back again.
  sorting().choose(1);
  QTest::keyClick(&table(), Qt::Key_Plus);
  sorting().choose(2);
  QTest::keyClick(&table(), Qt::Key_1);
  EXPECT_TRUE(wait_until(is_told, 2000));
  QTest::keyClick(&table(), Qt::Key_Backspace);
  EXPECT_TRUE(wait_until(is_told, 2000));
  sorting().move(3, {0.05, 0.05});
  trigger("finish_sorting");
  const auto whole = log();
  const auto last = std::ranges::find_if(whole.entries, [](const wale::SessionEntry& each) {
    return std::holds_alternative<wale::SessionGroups>(each.event);
  });
  ASSERT_NE(last, whole.entries.end());
  ASSERT_NE(last, whole.entries.begin());
  EXPECT_TRUE(std::holds_alternative<wale::SessionPlaced>((last - 1)->event))
      << "the places are there before the groups";
}

}  // namespace
}  // namespace sandpaper
