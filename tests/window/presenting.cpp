// What an experimenter and a participant do: a session with its log, a movie, keys that are sorted, shuffles.
#include <sys/resource.h>

#include <QAccessible>
#include <QDir>
#include <QFile>
#include <cmath>
#include <csignal>
#include <limits>
#include <map>
#include <set>
#include <wale/library.hpp>

#include "presented_window.hpp"

namespace sandpaper {
namespace {

TEST_F(PresentedWindow, ASortingSessionIsOnTheDiskAndInTheFile) {
  begin_session();
  ASSERT_TRUE(session().runs()) << announced().toStdString();
  EXPECT_EQ(QFileInfo(session().path()).fileName(), "surfaces-S48-1.session");
  start_sorting();
  trigger("feel");
  EXPECT_LT(felt_in_area(), 0.05);  // no key is chosen
  // The participant feels each key and drags it onto the first one that feels alike.
  std::map<std::string, double> felt;
  std::optional<std::size_t> hard, soft;
  for (std::size_t i = 0; i < 4; ++i) {
    click_key(i);
    ASSERT_EQ(sorting().chosen_index(), i);
    QTest::qWait(60);
    const double force = felt_in_area();
    felt[sorting().keys()[i].name] = force;
    auto& like = force > 1 ? hard : soft;
    if (like) drag_key(i, table().box_of(sorting().keys()[*like]).center().toPoint());
    else like = i;
  }
  EXPECT_NEAR(felt["oak_one"], 2, 0.2);
  EXPECT_NEAR(felt["oak_four"], 0.5, 0.1);
  ASSERT_EQ(sorting().piles().size(), 2u);
  // The pile of the chosen key gets a label; one more answer is taken back.
  sorting().choose(*hard);
  QTest::keyClick(&table(), Qt::Key_L);
  auto* label = table().parentWidget()->findChild<QLineEdit*>("pile_label");
  label->setText("rough, \"like bark\"");
  emit label->editingFinished();
  QTest::keyClick(&table(), Qt::Key_0);
  EXPECT_EQ(sorting().keys()[*hard].pile, 0);
  QTest::keyClick(&table(), Qt::Key_Backspace);
  EXPECT_NE(sorting().keys()[*hard].pile, 0);
  trigger("finish_sorting");
  EXPECT_FALSE(sorting().runs());
  const QString path = session().path();
  window->findChild<QPushButton*>("session_button")->click();
  EXPECT_FALSE(session().runs());

  const auto read_back = wale::open_session_log(path.toStdString());
  ASSERT_TRUE(read_back);
  EXPECT_TRUE(read_back->problems.empty());
  EXPECT_TRUE(read_back->ended());
  const auto& begun = std::get<wale::SessionBegin>(read_back->entries.front().event);
  EXPECT_EQ(begun.participant, "S48");
  EXPECT_EQ(begun.seed, 1995u);
  EXPECT_EQ(begun.file, "surfaces.wale");
  // One line for each material, not for each patch.
  const auto programs = all_of<wale::SessionProgram>(*read_back);
  ASSERT_EQ(programs.size(), 2u);
  EXPECT_EQ(programs[0].patch, "oak_one, oak_three");
  EXPECT_EQ(programs[0].material, "ridges(size: 2 N)");
  EXPECT_EQ(programs[1].patch, "oak_two, oak_four");
  EXPECT_EQ(programs[0].hash, wale::program_hash(*window->feeling().program(placed("oak_three").id)));
  // The answers alone tell the groups.
  std::map<std::string, std::string> pile_of;
  for (const wale::SessionEntry* each : read_back->standing_answers())
    if (const auto& answer = std::get<wale::SessionAnswer>(each->event); answer.question == "pile")
      pile_of[answer.about] = answer.answer;
  EXPECT_EQ(pile_of.at("oak_one"), pile_of.at("oak_three"));
  EXPECT_EQ(pile_of.at("oak_two"), pile_of.at("oak_four"));
  EXPECT_NE(pile_of.at("oak_one"), pile_of.at("oak_two"));
  // Each key was shown, under its number, before it was answered about.
  const auto numbered = all_of<wale::SessionOrder>(*read_back).back();
  EXPECT_EQ(numbered.what, "keys");
  std::set<std::string> shown;
  for (const wale::SessionEntry& each : read_back->entries) {
    if (const auto* key = std::get_if<wale::SessionShown>(&each.event); key && key->what == "key") {
      shown.insert(key->name);
      EXPECT_EQ(key->name, numbered.items.at(key->number - 1).name);
      EXPECT_EQ(key->label, numbered.items.at(key->number - 1).label);
    }
    if (const auto* answer = std::get_if<wale::SessionAnswer>(&each.event); answer && answer->question == "pile")
      EXPECT_FALSE(shown.empty());
  }
  EXPECT_EQ(shown.size(), 4u);
  const auto groups = all_of<wale::SessionGroups>(*read_back);
  ASSERT_EQ(groups.size(), 1u);
  // The file has them too, and is without errors.
  const std::string text = window->document().text();
  EXPECT_FALSE(language().check(text).has_errors()) << text;
  const auto shown_by_file = library().presentation(text);
  ASSERT_TRUE(shown_by_file);
  ASSERT_EQ(shown_by_file->groups.size(), 1u);
  const wale::SortedGroups& saved = shown_by_file->groups.front();
  EXPECT_EQ(saved.name, "sorted_S48");
  ASSERT_EQ(saved.groups.size(), 2u);
  for (const auto& each : saved.groups) {
    const bool is_hard = each.patches.front() == "oak_one";
    EXPECT_EQ(each.patches, is_hard ? (std::vector<std::string>{"oak_one", "oak_three"})
                                    : (std::vector<std::string>{"oak_four", "oak_two"}));
    EXPECT_EQ(each.says, is_hard ? "rough, \"like bark\"" : "");
  }
  trigger("undo");
  EXPECT_EQ(library().presentation(window->document().text())->groups.size(), 0u);
}

TEST_F(PresentedWindow, KeysAreSortedByKeyboardAlone) {
  const std::string before = window->document().text();
  start_sorting();
  table().setFocus();
  const auto press = [&](int key, Qt::KeyboardModifiers with = {}) {
    QTest::keyClick(&table(), static_cast<Qt::Key>(key), with);
  };
  press(Qt::Key_N);
  press(Qt::Key_Plus);  // the first key is pile 1
  press(Qt::Key_N);
  press(Qt::Key_Plus);  // the second is pile 2
  press(Qt::Key_N);
  press(Qt::Key_1);
  press(Qt::Key_N);
  press(Qt::Key_2);
  // In one window, no panel tells what a key is made of; afterwards they are back.
  EXPECT_FALSE(window->findChild<QWidget*>("dock_sliders")->isVisible());
  EXPECT_FALSE(window->findChild<QWidget*>("dock_text")->isVisible());
  const auto& keys = sorting().keys();
  EXPECT_EQ(keys[0].pile, 1);
  EXPECT_EQ(keys[1].pile, 2);
  EXPECT_EQ(keys[2].pile, 1);
  EXPECT_EQ(keys[3].pile, 2);
  press(Qt::Key_1, Qt::ControlModifier);  // the whole pile
  EXPECT_EQ(sorting().piles(), std::vector<int>{1});
  press(Qt::Key_Backspace);
  EXPECT_EQ(sorting().piles(), (std::vector<int>{1, 2}));
  // Keys of a pile do not lie on each other, and all are on the table.
  for (std::size_t i = 0; i < keys.size(); ++i) {
    EXPECT_TRUE(QRectF(table().rect()).contains(table().box_of(keys[i])));
    for (std::size_t k = 0; k < i; ++k) EXPECT_FALSE(table().box_of(keys[i]).intersects(table().box_of(keys[k])));
  }
  trigger("cancel_sorting");
  EXPECT_FALSE(sorting().runs());
  EXPECT_TRUE(window->findChild<QWidget*>("dock_sliders")->isVisible());
  EXPECT_EQ(window->document().text(), before);
}

TEST_F(PresentedWindow, AMovieIsOnTheDiskFrameByFrame) {
  begin_session();
  const std::string frames[] = {"second", "third", "second", "table"};
  for (std::size_t i = 0; i < 4; ++i) {
    trigger("next_frame");
    EXPECT_EQ(contents().name, frames[i]);
    const auto shown = all_of<wale::SessionShown>(log());
    ASSERT_EQ(shown.size(), i + 2);  // and the one with which the session began
    EXPECT_EQ(shown.back(), (wale::SessionShown{"frame", frames[i], "", static_cast<std::uint32_t>((i + 1) % 4 + 1)}));
  }
  trigger("previous_frame");
  EXPECT_EQ(contents().name, "second");
  // A frame that comes otherwise is told, too.
  ASSERT_TRUE(window->document().show_workspace("table"));
  EXPECT_EQ(all_of<wale::SessionShown>(log()).back().name, "table");
  // To step is to change nothing: neither the file nor what can be undone.
  EXPECT_FALSE(window->document().is_modified());
  EXPECT_FALSE(window->action("undo")->isEnabled());
  trigger("shuffle_frames");
  const auto order = all_of<wale::SessionOrder>(log()).back();
  EXPECT_EQ(order.what, "frames");
  EXPECT_EQ(order.of, "demo");
  ASSERT_EQ(order.items.size(), 4u);
  for (const wale::SessionItem& each : order.items) {
    trigger("next_frame");
    EXPECT_EQ(contents().name, each.name);
  }
}

TEST_F(PresentedWindow, AKilledSessionKeepsAllThatWasAcknowledged) {
  begin_session();
  for (int i = 0; i < 3; ++i) trigger("next_frame");
  // What is on the disk now is what a kill leaves.
  const std::string left = read(session().path());
  const auto lines = static_cast<std::size_t>(std::ranges::count(left, '\n'));
  const auto whole = wale::read_session_log(left, "left");
  ASSERT_TRUE(whole);
  EXPECT_TRUE(whole->problems.empty());
  EXPECT_FALSE(whole->ended());
  EXPECT_EQ(whole->entries.size(), lines);
  for (const std::size_t cut : {std::size_t{1}, std::size_t{20}}) {
    const auto shorter = wale::read_session_log(std::string_view(left).substr(0, left.size() - cut), "cut");
    ASSERT_TRUE(shorter);
    EXPECT_FALSE(shorter->problems.empty());
    EXPECT_GE(shorter->entries.size(), lines - 1);
  }
  window.reset();  // a window that closes says so
  const auto ended = wale::open_session_log(folder.filePath("surfaces-S48-1.session").toStdString());
  ASSERT_TRUE(ended);
  EXPECT_TRUE(ended->ended());
}

TEST_F(PresentedWindow, NothingIsPresentedThatAFullDiskDoesNotTake) {
  begin_session();
  trigger("next_frame");
  ASSERT_EQ(contents().name, "second");
  wait_for_programs();
  trigger("feel");
  ASSERT_TRUE(window->feeling().is_on());
  const auto size = static_cast<rlim_t>(QFileInfo(session().path()).size());
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit full{size, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &full);
  trigger("next_frame");
  const QString said = announced();
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(contents().name, "second");
  EXPECT_TRUE(said.contains("cannot be logged")) << said.toStdString();
  EXPECT_FALSE(window->feeling().is_on());
  EXPECT_TRUE(window->findChild<QLabel*>("session_state")->text().contains("cannot be written"));
  trigger("next_frame");  // there is room again
  EXPECT_EQ(contents().name, "third");
  EXPECT_TRUE(log().problems.empty());
  EXPECT_FALSE(window->findChild<QLabel*>("session_state")->text().contains("cannot be written"));
}

TEST_F(PresentedWindow, ALogIsNeverOverwrittenAndAFolderThatIsGoneIsSaid) {
  const QString taken = write("surfaces-S48-1.session", "mine\n");
  begin_session();
  EXPECT_EQ(QFileInfo(session().path()).fileName(), "surfaces-S48-2.session");
  EXPECT_EQ(read(taken), "mine\n");
  begin_session("");  // the button ends it
  EXPECT_FALSE(session().runs());
  begin_session("");
  EXPECT_TRUE(announced().contains("identifier")) << announced().toStdString();
  EXPECT_FALSE(session().runs());
  begin_session("S48", "4294967296");
  EXPECT_FALSE(session().runs());
  EXPECT_TRUE(window->findChild<QLabel*>("session_state")->text().contains("4294967295"));
  QDir(folder.path()).mkdir("gone");
  ASSERT_TRUE(QFile::copy(file, folder.filePath("gone/surfaces.wale")));
  ASSERT_TRUE(window->open(folder.filePath("gone/surfaces.wale")));
  ASSERT_TRUE(QDir(folder.filePath("gone")).removeRecursively());
  begin_session();
  EXPECT_FALSE(session().runs());
  EXPECT_TRUE(announced().contains("did not begin")) << announced().toStdString();
  window->document().make_new();
  begin_session();
  EXPECT_FALSE(session().runs());
  EXPECT_TRUE(announced().contains("save it first")) << announced().toStdString();
}

TEST_F(PresentedWindow, TheSameSeedGivesTheSameOrders) {
  std::vector<std::vector<wale::SessionOrder>> runs;
  for (const char* seed : {"7", "7", "8"}) {
    begin();
    ASSERT_TRUE(window->open(file));
    wait_for_programs();
    begin_session("S1", seed);
    ASSERT_TRUE(session().runs()) << announced().toStdString();
    trigger("shuffle_frames");
    trigger("shuffle");
    start_sorting();
    runs.push_back(all_of<wale::SessionOrder>(log()));
    ASSERT_EQ(runs.back().size(), 4u);
    for (const wale::SessionItem& each : runs.back().back().items)
      EXPECT_TRUE(QString::fromStdString(each.label).toInt() >= 100);
  }
  EXPECT_EQ(runs[0], runs[1]);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NE(runs[0][i].items, runs[2][i].items) << runs[0][i].what;
}

TEST_F(PresentedWindow, NumbersAreNewInEachSessionAndLogged) {
  trigger("random_numbers");
  std::vector<std::vector<std::string>> seen;
  for (const char* seed : {"1", "2"}) {
    begin_session("S1", seed);
    std::vector<std::string> labels;
    for (const PlacedRef& each : contents().placed) labels.push_back(canvas().label_of(*each).toStdString());
    for (const std::string& each : labels) EXPECT_EQ(each.size(), 3u) << each;
    EXPECT_EQ(std::set<std::string>(labels.begin(), labels.end()).size(), 4u);
    const auto logged = all_of<wale::SessionOrder>(log()).front();
    EXPECT_EQ(logged.what, "numbers");
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(logged.items[i].label, labels[i]);
    trigger("next_frame");
    trigger("previous_frame");
    EXPECT_EQ(canvas().label_of(placed("oak_one")).toStdString(),
              labels[0]);  // it keeps its own while the session runs
    seen.push_back(labels);
    window->findChild<QPushButton*>("session_button")->click();
  }
  EXPECT_NE(seen[0], seen[1]);
}

TEST_F(PresentedWindow, NothingTellsMaterialsToAParticipant) {
  trigger("participant");
  auto* participant = window->findChild<ParticipantWindow*>("participant_window");
  ASSERT_TRUE(participant && participant->isVisible());
  EXPECT_EQ(participant->canvas().look().surfaces, Look::blind);
  const auto told = [](QWidget& widget) {
    QString all;
    QAccessibleInterface* list = QAccessible::queryAccessibleInterface(&widget);
    for (int i = 0; i < list->childCount(); ++i)
      for (const auto kind : {QAccessible::Name, QAccessible::Value, QAccessible::Description})
        all += list->child(i)->text(kind) + "\n";
    return all;
  };
  EXPECT_FALSE(told(participant->canvas()).contains("oak"));
  EXPECT_FALSE(told(participant->canvas()).contains("ridges"));
  // All patches look alike: no colour is that of a material.
  wait_until([&] { return !window->is_busy(); });
  const QImage seen = participant->canvas().grab().toImage();
  const auto colour_at = [&](const std::string& name) {
    const glm::dvec2 at = placed(name).patch.at + glm::dvec2(0.01, -0.01);
    return seen.pixelColor(participant->canvas().to_pixels(at).toPoint());
  };
  EXPECT_EQ(colour_at("oak_one"), colour_at("oak_two"));
  EXPECT_EQ(colour_at("oak_one").saturation(), 0);
  // Keys with names have numbers then, on the participant's table too.
  window->presenting().start_sorting("by_name");
  ASSERT_TRUE(wait_until([&] { return sorting().runs(); }));
  EXPECT_EQ(participant->currentWidget(), &participant->page());
  EXPECT_FALSE(told(participant->page().table()).contains("oak"));
  sorting().choose(0);
  trigger("say_touched");
  EXPECT_EQ(announced(), sorting().keys().front().label);
  EXPECT_GE(sorting().keys().front().label.toInt(), 100);
  trigger("cancel_sorting");
  EXPECT_EQ(participant->currentWidget(), &participant->canvas());
  // What the window announces is not read out while a participant hears it.
  QStringList read_out;
  QObject::connect(window->findChild<Announcement*>(), &Announcement::read_out,
                   [&](const QString& words) { read_out << words; });
  trigger("next_frame");
  EXPECT_TRUE(announced().contains("second"));
  EXPECT_TRUE(read_out.isEmpty()) << read_out.join("|").toStdString();
  participant->close();
  EXPECT_FALSE(window->action("participant")->isChecked());
  trigger("next_frame");
  EXPECT_EQ(read_out.size(), 1);
  // Without the window the declaration holds; then the window does not open over names.
  window->presenting().start_sorting("by_name");
  ASSERT_TRUE(wait_until([&] { return sorting().runs(); }));
  EXPECT_TRUE(sorting().keys().front().label.startsWith("oak"));
  trigger("participant");
  EXPECT_FALSE(participant->isVisible());
}

/// A device that lies where it is put.
class Handle final : public wale::Device {
 public:
  const wale::DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long) noexcept override {}
  wale::Reading sample() noexcept override { return {.counts = counts}; }
  wale::Force command(wale::Force force) noexcept override { return force; }
  glm::ivec2 counts{0};

 private:
  wale::DeviceProfile profile_;
};

TEST_F(PresentedWindow, ADeviceIsRecentredAndTheMouseIsNot) {
  auto handle = std::make_unique<Handle>();
  Handle& own = *handle;
  own.counts = {120, -30};
  Recentred device(std::move(handle));
  EXPECT_EQ(device.sample().counts, glm::ivec2(120, -30));
  device.move_centre({100, -40});
  EXPECT_EQ(device.sample().counts, glm::ivec2(20, 10));
  own.counts = {std::numeric_limits<int>::min(), std::numeric_limits<int>::max()};
  EXPECT_EQ(device.sample().counts,
            glm::ivec2(std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));  // not around the corner

  trigger("recentre");
  EXPECT_TRUE(announced().contains("mouse")) << announced().toStdString();
  window->feeling().open("simulated");
  ASSERT_TRUE(wait_until([&] { return window->feeling().spelling() == "simulated"; })) << announced().toStdString();
  begin_session();
  trigger("feel");
  ASSERT_TRUE(wait_until([&] { return std::abs(window->feeling().now().position.x) > 0.005; }));
  trigger("recentre");
  EXPECT_FALSE(window->feeling().is_on());  // all lies elsewhere under the hand now
  EXPECT_NEAR(window->feeling().centre().x, window->feeling().now().position.x, 0.005);
  EXPECT_TRUE(std::ranges::any_of(all_of<wale::SessionNote>(log()),
                                  [](const auto& each) { return each.text.find("centre") != std::string::npos; }));
  trigger("centre_back");
  EXPECT_EQ(window->feeling().centre(), glm::dvec2(0));
}

}  // namespace
}  // namespace sandpaper
