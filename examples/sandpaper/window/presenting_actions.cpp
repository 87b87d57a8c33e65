// What is presented to a participant: movies, shuffles, keys to sort, the session and its log.
#include <QDockWidget>
#include <QLineEdit>
#include <QMenuBar>
#include <QStatusBar>
#include <utility>

#include "window/main_window.hpp"

namespace sandpaper {

void MainWindow::make_present_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&Present"));
  add(menu, "session", tr("&Session …"), tr("Ctrl+Shift+E"), [this] {
    auto* dock = findChild<QDockWidget*>("dock_session");
    dock->show();
    dock->raise();
    findChild<QWidget*>(presenting_.session().runs() ? "session_button" : "participant_id")->setFocus();
  });
  menu->addSeparator();
  add(menu, "next_frame", tr("&Next workspace of the movie"), tr("F8"), [this] {
    editor_->commit();
    presenting_.step(1);
  });
  add(menu, "previous_frame", tr("&Previous workspace of the movie"), tr("F7"), [this] {
    editor_->commit();
    presenting_.step(-1);
  });
  QMenu* movies = menu->addMenu(tr("&Movie"));
  connect(movies, &QMenu::aboutToShow, this, [this, movies] {
    movies->clear();
    presenting_.frames();  // which movie it is
    for (const QString& each : presenting_.movies()) {
      auto* action = movies->addAction(each);
      action->setCheckable(true);
      action->setChecked(each == presenting_.movie());
      connect(action, &QAction::triggered, this, [this, each] { presenting_.choose_movie(each); });
    }
    if (movies->isEmpty()) movies->addAction(tr("the file declares none: all its workspaces are"))->setEnabled(false);
  });
  add(menu, "shuffle_frames", tr("Shuffle the movie's &order"), tr("Shift+F9"), [this] {
    editor_->commit();
    presenting_.shuffle_frames();
  });
  add(menu, "shuffle", tr("Shuffle the patches' p&laces"), tr("F9"), [this] {
    editor_->commit();
    presenting_.shuffle_places([this](const Placed& placed) { return canvas_->size_of(placed); });
  });
  menu->addSeparator();
  QMenu* keys = menu->addMenu(tr("Sort by &keys"));
  add(menu, "start_sorting", tr("S&ort by the first keys"), tr("F6"), [this] {
    editor_->commit();
    presenting_.start_sorting();
  });
  connect(keys, &QMenu::aboutToShow, this, [this, keys] {
    keys->clear();
    for (const QString& each : presenting_.keys())
      connect(keys->addAction(each), &QAction::triggered, this, [this, each] {
        editor_->commit();
        presenting_.start_sorting(each);
      });
    if (keys->isEmpty()) keys->addAction(tr("the file declares none"))->setEnabled(false);
  });
  QMenu* piles = menu->addMenu(tr("The &chosen key"));
  const auto of_chosen = [this](const auto& act) {
    return [this, act] {
      Sorting& sorting = presenting_.sorting();
      if (const auto chosen = sorting.chosen_index()) return act(sorting, *chosen);
      announcement_->say(tr("No key is chosen: there is one when a sort runs and a key was clicked"));
    };
  };
  add(piles, "new_pile", tr("Into a &new pile (+)"), {},
      of_chosen([](Sorting& sorting, std::size_t key) { sorting.put(key, sorting.new_pile()); }));
  add(piles, "take_out", tr("&Out of its pile (0)"), {},
      of_chosen([](Sorting& sorting, std::size_t key) { sorting.put(key, 0); }));
  add(piles, "label_pile", tr("&Label its pile (L)"), {},
      of_chosen([this](Sorting&, std::size_t) { sorting_page_->ask_label(); }));
  add(piles, "take_back", tr("Take the last answer &back (Backspace)"), {},
      [this] { presenting_.sorting().take_back(); });
  add(menu, "finish_sorting", tr("&Finish the sort and save its groups"), tr("Ctrl+Return"),
      [this] { presenting_.finish_sorting(); });
  add(menu, "cancel_sorting", tr("Break the sort o&ff"), tr("Shift+F6"), [this] {
    presenting_.cancel_sorting("by the experimenter");
    announcement_->say(tr("The sort was broken off; no groups are saved"));
  });
  menu->addSeparator();
  add_toggle(menu, "blind_patches", tr("&Blind patches for the participant"), tr("Ctrl+B"), true, [this](bool on) {
    if (participant_) participant_->set_blind(on);
  });
  add(menu, "recentre", tr("&Recentre: the handle is in the middle"), tr("F4"), [this] { presenting_.recentre(); });
  add(menu, "centre_back", tr("The &device's own centre"), tr("Shift+F4"), [this] { presenting_.centre_back(); });
}

void MainWindow::make_sorting() {
  sorting_page_ = new SortingPage(presenting_.sorting(), feeling_);
  sorting_page_->setObjectName("sorting");
  pages_of_work_->addWidget(sorting_page_);
  connect(sorting_page_, &SortingPage::done, &presenting_, &Presenting::finish_sorting);
  connect(&presenting_, &Presenting::said, announcement_, &Announcement::say);
  connect(&presenting_, &Presenting::felt_changed, this, [this] { feeling_.follow(presenting_.felt()); });
  connect(&presenting_.sorting(), &Sorting::changed, this, &MainWindow::update_presenting);
  connect(&presenting_.session(), &Session::changed, this, &MainWindow::update_title);
  connect(session_panel_, &SessionPanel::begin_wanted, this, [this](const QString& participant, std::uint32_t seed) {
    editor_->commit();
    presenting_.begin_session(participant, seed);
  });
  update_presenting();
}

void MainWindow::update_presenting() {
  const bool sorts = presenting_.sorting().runs();
  QWidget* page = sorts ? static_cast<QWidget*>(sorting_page_) : canvas_;
  if (pages_of_work_->currentWidget() != page) {
    pages_of_work_->setCurrentWidget(page);
    if (isActiveWindow()) page->setFocus();
    // In one window, the participant would read in the panels what each key is made of.
    if (sorts && !(participant_ && participant_->isVisible())) {
      panels_before_ = saveState();
      for (QDockWidget* each : findChildren<QDockWidget*>()) each->hide();
      statusBar()->clearMessage();
    } else if (!sorts && !panels_before_.isEmpty()) {
      restoreState(std::exchange(panels_before_, {}));
    }
  }
  for (const char* name : {"finish_sorting", "cancel_sorting"})
    if (QAction* each = action(name)) each->setEnabled(sorts);
}

void MainWindow::show_participant(bool shown) {
  if (!participant_) {
    participant_ = new ParticipantWindow(document_, feeling_, pictures_, numbers_, presenting_.sorting(), this);
    participant_->set_blind(action("blind_patches")->isChecked());
    connect(&participant_->page(), &SortingPage::done, &presenting_, &Presenting::finish_sorting);
    connect(participant_, &ParticipantWindow::visible_changed, this, [this](bool visible) {
      action("participant")->setChecked(visible);
      presenting_.set_hides_names(visible);
      announcement_->set_quiet(visible);
    });
    // The keys of the session work while this window is the active one, too.
    for (const char* name : {"next_frame", "previous_frame", "finish_sorting", "feel"})
      participant_->addAction(action(name));
  }
  const Sorting& sorting = presenting_.sorting();
  if (shown && sorting.runs() && !sorting.declared().numbered_at_random) {
    action("participant")->setChecked(false);
    return announcement_->say(tr("The keys have names for labels: finish the sort first, or break it off"));
  }
  participant_->set_look(canvas_->look());
  participant_->setVisible(shown);
}

}  // namespace sandpaper
