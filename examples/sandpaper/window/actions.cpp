// The menus: every command, with its key.
#include <QAccessible>
#include <QActionGroup>
#include <QApplication>
#include <QDesktopServices>
#include <QDockWidget>
#include <QInputDialog>
#include <QMenuBar>
#include <QProcess>
#include <QSettings>
#include <QStatusBar>
#include <QUrl>

#include "document/arranging.hpp"
#include "document/counted.hpp"
#include "window/main_window.hpp"

namespace sandpaper {
namespace {

constexpr int said_milliseconds = 10000;

}  // namespace

QAction* MainWindow::add(QMenu* menu, const QString& name, const QString& text, const QKeySequence& key,
                         const std::function<void()>& act) {
  auto* action = menu->addAction(text);
  action->setObjectName(name);
  action->setShortcut(key);
  connect(action, &QAction::triggered, this, [act] { act(); });
  return action;
}

QAction* MainWindow::add_toggle(QMenu* menu, const QString& name, const QString& text, const QKeySequence& key, bool on,
                                const std::function<void(bool)>& act) {
  auto* action = menu->addAction(text);
  action->setObjectName(name);
  action->setShortcut(key);
  action->setCheckable(true);
  action->setChecked(on);
  connect(action, &QAction::triggered, this, act);
  return action;
}

void MainWindow::make_file_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&File"));
  add(menu, "new", tr("&New"), QKeySequence::New, [this] {
    when_saved(tr("begin a new one"), [this] {
      feeling_.set_on(false);
      document_.make_new();
    });
  });
  add(menu, "open", tr("&Open …"), QKeySequence::Open, [this] { open_asked(); });
  QMenu* workspaces = menu->addMenu(tr("&Workspace of this file"));
  connect(workspaces, &QMenu::aboutToShow, this, [this, workspaces] {
    workspaces->clear();
    for (const QString& each : document_.workspaces()) {
      auto* action = workspaces->addAction(each);
      action->setCheckable(true);
      action->setChecked(each.toStdString() == document_.contents().name);
      connect(action, &QAction::triggered, this, [this, each] { document_.show_workspace(each); });
    }
    if (workspaces->isEmpty()) workspaces->addAction(tr("none is saved"))->setEnabled(false);
  });
  menu->addSeparator();
  add(menu, "save", tr("&Save"), QKeySequence::Save, [this] { save(); });
  add(menu, "save_as", tr("Save &as …"), QKeySequence::SaveAs, [this] { save_as(); });
  menu->addSeparator();
  exchange_->add_to(*menu, *this);
  menu->addSeparator();
  add(menu, "quit", tr("&Quit"), QKeySequence::Quit, [this] { close(); });
}

void MainWindow::make_edit_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&Edit"));
  QAction* undo = document_.undo_stack().createUndoAction(this, tr("&Undo"));
  undo->setShortcut(QKeySequence::Undo);
  undo->setObjectName("undo");
  QAction* redo = document_.undo_stack().createRedoAction(this, tr("&Redo"));
  redo->setShortcut(QKeySequence::Redo);
  redo->setObjectName("redo");
  menu->addAction(undo);
  menu->addAction(redo);
  menu->addSeparator();
  add(menu, "duplicate", tr("&Duplicate"), tr("Ctrl+D"), [this] { duplicate(document_); });
  // Keys that a text or a list needs itself: only the canvas has them.
  const auto on_canvas = [this](QAction* action) {
    action->setShortcutContext(Qt::WidgetShortcut);
    canvas_->addAction(action);
  };
  auto* remove =
      add(menu, "delete", tr("De&lete"), QKeySequence::Delete, [this] { document_.remove(document_.chosen()); });
  on_canvas(remove);
  auto* all = add(menu, "choose_all", tr("Choose &all"), QKeySequence::SelectAll, [this] {
    std::set<std::uint64_t> ids;
    for (const PlacedRef& each : document_.contents().placed)
      if (each->is_laid_out()) ids.insert(each->id);
    document_.choose(ids);
  });
  on_canvas(all);
  add(menu, "rename", tr("Re&name …"), tr("F2"), [this] {
    const Placed* chosen = document_.contents().find(*document_.chosen().begin());
    if (!chosen) return;
    bool ok = false;
    const QString name = QInputDialog::getText(this, tr("Rename"), tr("Name of the patch"), QLineEdit::Normal,
                                               QString::fromStdString(chosen->patch.name), &ok);
    if (!ok || name.toStdString() == chosen->patch.name) return;
    const std::string free = document_.contents().new_name(name.toStdString());
    document_.change_placed(tr("Rename"), {chosen->id}, [&](Placed& placed) { placed.patch.name = free; });
    if (free != name.toStdString())
      announcement_->say(
          tr("It is called %1: a name has letters, digits and _, and is there once").arg(QString::fromStdString(free)));
  });
  menu->addSeparator();
  const int far = 1 << 30;
  on_canvas(add(menu, "raise", tr("R&aise"), tr("PgUp"), [this] { document_.raise(document_.chosen(), 1); }));
  on_canvas(add(menu, "lower", tr("&Lower"), tr("PgDown"), [this] { document_.raise(document_.chosen(), -1); }));
  on_canvas(add(menu, "front", tr("To the &front"), tr("Ctrl+PgUp"),
                [this, far] { document_.raise(document_.chosen(), far); }));
  on_canvas(add(menu, "back", tr("To the &back"), tr("Ctrl+PgDown"),
                [this, far] { document_.raise(document_.chosen(), -far); }));
  add(menu, "lock", tr("Loc&k or unlock"), tr("Ctrl+L"), [this] {
    bool all = true;
    for (const auto id : document_.chosen())
      if (const Placed* each = document_.contents().find(id)) all = all && each->locked;
    document_.change_placed(all ? tr("Unlock") : tr("Lock"), document_.chosen(),
                            [all](Placed& placed) { placed.locked = !all; });
  });
  QMenu* alignment = menu->addMenu(tr("Al&ign"));
  const auto size_of = [this](const Placed& placed) { return canvas_->size_of(placed); };
  const std::tuple<const char*, QString, Alignment, const char*> ways[] = {
      {"align_left", tr("&left edges"), Alignment::left, "Ctrl+Shift+Left"},
      {"align_right", tr("&right edges"), Alignment::right, "Ctrl+Shift+Right"},
      {"align_top", tr("&upper edges"), Alignment::top, "Ctrl+Shift+Up"},
      {"align_bottom", tr("lo&wer edges"), Alignment::bottom, "Ctrl+Shift+Down"},
      {"align_x", tr("centres, one above the &other"), Alignment::centre_x, "Ctrl+Shift+C"},
      {"align_y", tr("centres, &side by side"), Alignment::centre_y, "Ctrl+Shift+M"}};
  for (const auto& [name, text, alignment_of, key] : ways) {
    const Alignment wanted = alignment_of;
    on_canvas(
        add(alignment, name, text, QKeySequence(key), [this, wanted, size_of] { align(document_, wanted, size_of); }));
  }
  add(menu, "fit", tr("Fit into the device's &reach"), tr("Ctrl+R"), [this, size_of] {
    const int moved = fit(document_, feeling_.profile().workspace_diameter, size_of);
    announcement_->say(moved == 0 ? tr("Nothing had to be moved") : tr("%1 moved").arg(counted(moved, "patch", "patches")));
  });
  QMenu* shape = menu->addMenu(tr("&Shape"));
  add(shape, "rectangle", tr("&Rectangle"), {}, [this] {
    document_.change_placed(tr("Rectangle"), document_.chosen(), [this](Placed& placed) {
      if (!placed.patch.size) placed.patch.size = canvas_->size_of(placed);
      placed.patch.shape.clear(), placed.patch.outline = {};
    });
  });
  add(shape, "ellipse", tr("&Ellipse"), {}, [this] {
    document_.change_placed(tr("Ellipse"), document_.chosen(), [this](Placed& placed) {
      if (!placed.patch.size) placed.patch.size = canvas_->size_of(placed);
      placed.patch.shape = "ellipse";
      if (auto circle = wale::Shape::ellipse(0.5f, 0.5f)) placed.patch.outline = *std::move(circle);
    });
  });
}

void MainWindow::make_view_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&View"));
  add(menu, "zoom_in", tr("Zoom &in"), QKeySequence::ZoomIn, [this] { canvas_->zoom(1.25); });
  add(menu, "zoom_out", tr("Zoom &out"), QKeySequence::ZoomOut, [this] { canvas_->zoom(0.8); });
  add(menu, "show_all", tr("Show &everything"), tr("Ctrl+0"), [this] { canvas_->show_all(); });
  menu->addSeparator();
  const auto change = [this](auto edit) {
    CanvasLook look = canvas_->look();
    edit(look);
    canvas_->set_look(look);
    if (participant_) participant_->set_look(look);
  };
  QMenu* looks = menu->addMenu(tr("&Surfaces"));
  auto* look_group = new QActionGroup(this);
  const std::tuple<const char*, QString, Look, const char*> surfaces[] = {
      {"look_relief", tr("&Relief"), Look::relief, "Ctrl+1"},
      {"look_blind", tr("&Blind"), Look::blind, "Ctrl+2"},
      {"look_depth", tr("&Depth map"), Look::depth, "Ctrl+3"},
      {"look_force", tr("&Force field"), Look::force_field, "Ctrl+4"}};
  for (const auto& [name, text, look, key] : surfaces) {
    const Look wanted = look;
    look_group->addAction(
        add_toggle(looks, name, text, QKeySequence(key), wanted == Look::relief,
                   [change, wanted](bool) { change([=](CanvasLook& each) { each.surfaces = wanted; }); }));
  }
  QMenu* cursors = menu->addMenu(tr("&Cursor"));
  auto* cursor_group = new QActionGroup(this);
  const std::pair<QString, Cursor> kinds[] = {{tr("&Ring"), Cursor::ring},
                                              {tr("&Square"), Cursor::square},
                                              {tr("With a &drop shadow"), Cursor::drop_shadow},
                                              {tr("&Hidden"), Cursor::hidden}};
  for (const auto& [text, kind] : kinds) {
    const Cursor wanted = kind;
    cursor_group->addAction(
        add_toggle(cursors, "cursor_" + QString::number(static_cast<int>(wanted)), text, {}, wanted == Cursor::ring,
                   [change, wanted](bool) { change([=](CanvasLook& each) { each.cursor = wanted; }); }));
  }
  cursors->addSeparator();
  add_toggle(cursors, "cursor_behind", tr("&Behind the marks"), {}, false,
             [change](bool on) { change([=](CanvasLook& each) { each.cursor_behind = on; }); });
  add_toggle(menu, "show_force", tr("Force as an &arrow"), tr("Ctrl+Shift+F"), true,
             [change](bool on) { change([=](CanvasLook& each) { each.force = on; }); });
  add_toggle(menu, "show_grid", tr("&Grid"), tr("Ctrl+G"), true,
             [change](bool on) { change([=](CanvasLook& each) { each.grid = on; }); });
  add_toggle(menu, "show_names", tr("&Names"), tr("Ctrl+Shift+N"), true,
             [change](bool on) { change([=](CanvasLook& each) { each.names = on; }); });
  add_toggle(menu, "random_numbers", tr("Three-digit n&umbers for names"), {}, false,
             [change](bool on) { change([=](CanvasLook& each) { each.random_numbers = on; }); });
  add_toggle(menu, "black", tr("&Black background"), {}, false,
             [change](bool on) { change([=](CanvasLook& each) { each.black = on; }); });
  QMenu* snapping = menu->addMenu(tr("Sna&p to"));
  auto* snap_group = new QActionGroup(this);
  const std::pair<QString, double> steps[] = {
      {tr("nothing"), 0}, {tr("0.1 mm"), 1e-4}, {tr("1 mm"), 1e-3}, {tr("5 mm"), 5e-3}};
  for (const auto& [text, step] : steps) {
    const double wanted = step;
    snap_group->addAction(add_toggle(snapping, "snap_" + QString::number(wanted * 1000), text, {}, wanted == 1e-3,
                                     [this, wanted](bool) { canvas_->set_snap(wanted); }));
  }
  menu->addSeparator();
  int number = 0;
  for (QDockWidget* dock : findChildren<QDockWidget*>()) {
    QAction* toggle = dock->toggleViewAction();
    toggle->setShortcut(QKeySequence(QString("Alt+%1").arg(++number)));
    menu->addAction(toggle);
  }
  add_toggle(menu, "participant", tr("Participant's &window"), tr("Ctrl+Shift+P"), false,
             [this](bool on) { show_participant(on); });
}

void MainWindow::make_feel_menu() {
  QMenu* menu = menuBar()->addMenu(tr("F&eel"));
  add_toggle(menu, "feel", tr("&Feel it"), tr("Ctrl+Space"), false, [this](bool on) {
    feeling_.set_on(on);
    update_safety();  // a run that could not begin has changed nothing, but the mark of this command
  })->setShortcutContext(Qt::WindowShortcut);
  add(menu, "no_force", tr("&Take all force away (Space)"), {}, [this] { feeling_.set_on(false); });
  add_toggle(menu, "feel_when_opened", tr("Feel this file as soon as it is &opened"), {}, false, [this](bool on) {
    QSettings settings;
    QStringList files = settings.value("felt_when_opened").toStringList();
    files.removeAll(document_.file());
    if (on && !document_.file().isEmpty()) files << document_.file();
    settings.setValue("felt_when_opened", files);
    if (on && document_.file().isEmpty()) {
      announcement_->say(tr("Save the workspace first: what is felt when opened is a file"));
      action("feel_when_opened")->setChecked(false);
    }
  });
  menu->addSeparator();
  add(menu, "compare", tr("&Compare the two chosen patches"), tr("Ctrl+Shift+D"), [this] {
    auto* dock = findChild<QDockWidget*>("dock_description");
    dock->show();
    dock->raise();
    dock->findChild<QPlainTextEdit*>()->setFocus();
  });
  QAction* hear = add_toggle(menu, "hear", tr("&Hear the force"), tr("Ctrl+Shift+H"), false,
                             [this](bool on) { sound_.set_wished(on); });
  connect(&sound_, &Sound::wished_changed, hear, &QAction::setChecked);
  add(menu, "say_touched", tr("&Say what is touched"), tr("Ctrl+T"), [this] {
    const auto touched = canvas_->touched();
    const Placed* placed = touched ? document_.contents().find(*touched) : nullptr;
    // A participant hears it too.
    const Canvas& told = participant_ && participant_->isVisible() ? participant_->canvas() : *canvas_;
    const SortingKey* key = presenting_.sorting().chosen();
    const QString words = presenting_.sorting().runs() ? (key ? key->label : tr("no key is chosen"))
                          : placed                     ? told.told_of(*placed)
                                                       : tr("nothing is touched");
    announcement_->say(words);
    if (!QProcess::startDetached("spd-say", {words}) && !QAccessible::isActive())
      statusBar()->showMessage(tr("Nothing speaks here: install speech-dispatcher, or use a screen reader"),
                               said_milliseconds);
  });
  add(menu, "devices", tr("Look for &devices again"), tr("F5"), [this] {
    device_->clear();
    for (const auto& [spelling, name] : feeling_.choices()) device_->addItem(name, spelling);
    update_safety();
    announcement_->say(tr("%1 can be chosen").arg(counted(device_->count(), "device", "devices")));
  });
}

void MainWindow::make_help_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&Help"));
  add(menu, "learn", tr("A &quarter of an hour"), tr("Shift+F1"), [this] { show_page("examples/learn/README.md"); });
  add(menu, "recipes", tr("&Recipes"), tr("Ctrl+F1"), [this] { show_page("examples/learn/RECIPES.md"); });
  add(menu, "forces", tr("Which &word makes which force"), {}, [this] { show_page("examples/learn/FORCES.md"); });
  add(menu, "language", tr("The &language"), {}, [this] { show_page("schema/LANGUAGE.md"); });
  menu->addSeparator();
  add(menu, "keys", tr("&Keys"), tr("F1"), [this] {
    announcement_->say(
        tr("Space or Esc takes all force away. On the canvas: arrows move by 1 mm (with Shift 10, with Ctrl 0.1), "
           "N and P choose the next and the previous patch (with Shift besides), the wheel zooms, the middle button pans, Alt moves a "
           "patch without snapping. In the text: Ctrl+Space proposes words, Ctrl+. mends."));
  });
  add(menu, "about", tr("&About"), {}, [this] {
    announcement_->say(tr("Sandpaper: a workspace for materials that are felt, after Margaret Minsky's of 1995."));
  });
}

}  // namespace sandpaper
