#include "window/main_window.hpp"

#include <QAbstractSpinBox>
#include <QApplication>
#include <QCloseEvent>
#include <QDateTime>
#include <QDockWidget>
#include <QKeyEvent>
#include <QLineEdit>
#include <QStatusBar>
#include <QToolBar>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

namespace sandpaper {
namespace {

constexpr int before_advice = 800;     // ms without a change
constexpr int while_written = 300;     // ms after another program wrote into the file
constexpr qint64 while_typing = 1000;  // ms: a space that comes sooner after another key belongs to the text

bool takes_text(QWidget* widget) {
  if (const auto* field = qobject_cast<QPlainTextEdit*>(widget)) return !field->isReadOnly();
  return qobject_cast<QLineEdit*>(widget) || qobject_cast<QAbstractSpinBox*>(widget);
}

}  // namespace

MainWindow::MainWindow(const wale::Library& library, const wale::LanguageService& language, QWidget* parent)
    : QMainWindow(parent),
      library_(library),
      language_(language),
      document_(language),
      numbers_(document_),
      programs_(language),
      feeling_(library, programs_),
      sound_(feeling_.heard()),
      presenting_(library, document_, numbers_, feeling_),
      catalogue_(wale::library_catalogue()),
      autosave_(document_),
      canvas_(new Canvas(document_, feeling_, pictures_, numbers_)),
      pages_of_work_(new QStackedWidget),
      announcement_(new Announcement(pages_of_work_)),
      question_(new Question),
      work_(new LongWork),
      description_(new DescriptionPanel(language)),
      editor_(new TextEditor(document_, language)) {
  setObjectName("sandpaper");
  canvas_->setObjectName("canvas");
  auto* middle = new QWidget;
  auto* layout = new QVBoxLayout(middle);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(0);
  layout->addWidget(question_);
  layout->addWidget(work_);
  exchange_ = new Exchange(library_, language_, document_, feeling_, *canvas_, *editor_, *question_, *work_);
  exchange_->setParent(this);
  pages_of_work_->addWidget(canvas_);
  layout->addWidget(pages_of_work_, 1);
  setCentralWidget(middle);
  make_panels();
  exchange_->set_shown([this] { return sliders_->shown(); });
  connect(exchange_, &Exchange::said, announcement_, &Announcement::say);
  connect(exchange_, &Exchange::refused, this, &MainWindow::announce);
  make_safety_bar();
  make_file_menu();
  make_edit_menu();
  make_view_menu();
  make_feel_menu();
  make_present_menu();
  make_help_menu();
  make_sorting();
  resize(1280, 760);

  connect(&document_, &Document::contents_changed, this, [this] {
    feeling_.follow(presenting_.felt());
    update_actions();
    update_description();
    advising_.start(before_advice);
  });
  advising_.setSingleShot(true);
  connect(&advising_, &QTimer::timeout, this, &MainWindow::seek_advice);
  connect(&document_, &Document::file_changed, this, [this] {
    update_title();
    watch();
  });
  written_elsewhere_.setSingleShot(true);
  written_elsewhere_.setInterval(while_written);
  connect(&watched_, &QFileSystemWatcher::fileChanged, &written_elsewhere_, qOverload<>(&QTimer::start));
  connect(&written_elsewhere_, &QTimer::timeout, this, &MainWindow::follow_file);
  connect(&document_, &Document::chosen_changed, this, [this] {
    update_actions();
    update_description();
  });
  connect(&document_, &Document::refused, announcement_, &Announcement::say);
  autosave_.set_typed([this] { return editor_->typed(); });
  connect(editor_, &TextEditor::typing, &autosave_, &Autosave::changed);
  connect(&autosave_, &Autosave::failed, announcement_, &Announcement::say);
  connect(&document_.undo_stack(), &QUndoStack::indexChanged, this, &MainWindow::update_title);
  connect(&document_.undo_stack(), &QUndoStack::cleanChanged, this, &MainWindow::update_title);
  connect(&feeling_, &Feeling::said, announcement_, &Announcement::say);
  for (auto signal : {&Feeling::on_changed, &Feeling::device_changed})
    connect(&feeling_, signal, this, [this] {
      update_safety();
      sound_.follow(feeling_.is_on(), feeling_.profile());
    });
  connect(&sound_, &Sound::said, announcement_, &Announcement::say);
  connect(&feeling_, &Feeling::programs_changed, this, &MainWindow::update_description);
  connect(canvas_, &Canvas::touched_changed, this, &MainWindow::touched_changed);
  connect(canvas_, &Canvas::hovered, this, [this](glm::dvec2 at) {
    place_->setText(tr("%1, %2 mm").arg(1000 * at.x, 0, 'f', 1).arg(1000 * at.y, 0, 'f', 1));
  });
  connect(canvas_, &Canvas::material_dropped, this, &MainWindow::place_material);
  connect(canvas_, &Canvas::recipe_dropped, this, &MainWindow::place_recipe);
  connect(canvas_, &Canvas::others_dropped, this, &MainWindow::take_dropped);
  connect(canvas_, &Canvas::file_dropped, this, [this](const QString& file) {
    when_saved(tr("open another file"), [this, file] { open(file); });
  });
  connect(palette_, &PalettePanel::wanted, this, [this](const QString& spelling) {
    place_material(spelling, canvas_->to_metres(QPointF(canvas_->width() / 2.0, canvas_->height() / 2.0)));
  });
  connect(pages_, &PagesPanel::recipe_wanted, this, [this](const QString& recipe) {
    place_recipe(recipe, canvas_->to_metres(QPointF(canvas_->width() / 2.0, canvas_->height() / 2.0)));
  });
  connect(pages_, &PagesPanel::refused, announcement_, &Announcement::say);
  connect(sliders_, &SliderPanel::shown_changed, this, &MainWindow::update_description);
  connect(&plotting_, &QTimer::timeout, this, [this] {
    if (!feeling_.is_on()) return;
    const wale::Now& now = canvas_->now();
    plots_->add(now);
    if (now.guards.lost > 0 && lost_ == 0)
      announcement_->say(tr("The device is gone: there is no force until it is back."));
    lost_ = now.guards.lost;
  });
  plotting_.start(16);
  qApp->installEventFilter(this);
  update_title();
  update_safety();
  update_actions();
  update_description();
  offer_left_behind();
}

MainWindow::~MainWindow() {
  qApp->removeEventFilter(this);
  feeling_.set_on(false);
  delete exchange_;  // it uses the lines of the window
  // The panels use the parts of the window, which end before its children.
  presenting_.end("the window was closed");
  delete participant_;
  qDeleteAll(findChildren<QDockWidget*>());
  delete takeCentralWidget();
}

QString MainWindow::no_force() { return tr("All force is taken away."); }

void MainWindow::make_panels() {
  palette_ = new PalettePanel(*catalogue_, programs_, pictures_);
  sliders_ = new SliderPanel(document_, feeling_);
  plots_ = new PlotPanel;
  const auto dock = [this](const QString& name, const QString& title, QWidget* widget, Qt::DockWidgetArea area) {
    auto* dock = new QDockWidget(title);
    dock->setObjectName("dock_" + name);
    dock->setWidget(widget);
    addDockWidget(area, dock);
    return dock;
  };
  dock("palette", tr("Library"), palette_, Qt::LeftDockWidgetArea);
  auto* sliders = dock("sliders", tr("Sliders"), sliders_, Qt::RightDockWidgetArea);
  auto* description = dock("description", tr("Feels like"), description_, Qt::RightDockWidgetArea);
  splitDockWidget(sliders, description, Qt::Vertical);
  auto* text = dock("text", tr("Text"), editor_, Qt::BottomDockWidgetArea);
  // Beside the text: once the text is one of several tabs, the pages would be another.
  pages_ = new PagesPanel;
  auto* pages = dock("pages", tr("Learn"), pages_, Qt::BottomDockWidgetArea);
  splitDockWidget(text, pages, Qt::Horizontal);
  pages->hide();
  session_panel_ = new SessionPanel(presenting_.session());
  auto* plots = dock("plots", tr("Run"), plots_, Qt::BottomDockWidgetArea);
  tabifyDockWidget(text, plots);
  preview_ = new PreviewPanel(language_);
  tabifyDockWidget(plots, dock("preview", tr("Preview"), preview_, Qt::BottomDockWidgetArea));
  dock("session", tr("Session"), session_panel_, Qt::RightDockWidgetArea)->hide();
  text->raise();
  resizeDocks({findChild<QDockWidget*>("dock_palette"), sliders}, {230, 330}, Qt::Horizontal);
  resizeDocks({text}, {210}, Qt::Vertical);
  resizeDocks({sliders, description}, {300, 260}, Qt::Vertical);
  place_ = new QLabel;
  statusBar()->addPermanentWidget(place_);
}

void MainWindow::make_safety_bar() {
  auto* bar = addToolBar(tr("Force"));
  bar->setObjectName("force_bar");
  bar->setMovable(false);
  bar->toggleViewAction()->setEnabled(false);  // it is always there
  force_button_ = new QPushButton;
  force_button_->setObjectName("force");
  force_button_->setMinimumWidth(190);
  force_button_->setFocusPolicy(Qt::TabFocus);
  connect(force_button_, &QPushButton::clicked, this, [this] { feeling_.set_on(!feeling_.is_on()); });
  limit_ = new QDoubleSpinBox;
  limit_->setObjectName("limit");
  limit_->setDecimals(2);
  limit_->setSuffix(tr(" N"));
  limit_->setPrefix(tr("at most "));
  limit_->setAccessibleName(tr("Force limit in newtons"));
  limit_->setKeyboardTracking(false);
  connect(limit_, &QDoubleSpinBox::valueChanged, &feeling_, &Feeling::set_max_force);
  device_ = new QComboBox;
  device_->setObjectName("device");
  device_->setAccessibleName(tr("Device"));
  device_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  device_->setMinimumContentsLength(24);
  for (const auto& [spelling, name] : feeling_.choices()) device_->addItem(name, spelling);
  connect(device_, &QComboBox::activated, this, [this](int at) { feeling_.open(device_->itemData(at).toString()); });
  bar->addWidget(force_button_);
  bar->addWidget(limit_);
  bar->addSeparator();
  bar->addWidget(device_);
}

void MainWindow::update_safety() {
  const bool on = feeling_.is_on();
  if (on) announcement_->withdraw(no_force());
  force_button_->setText(on ? tr("Take all force away (Space)") : tr("Feel it (Ctrl+Space)"));
  force_button_->setAccessibleName(on ? tr("Take all force away") : tr("Feel it"));
  QPalette colours = palette();
  if (on) {
    colours.setColor(QPalette::Button, QColor(190, 30, 30));
    colours.setColor(QPalette::ButtonText, Qt::white);
  }
  force_button_->setPalette(colours);
  const QSignalBlocker quiet_limit(limit_), quiet_device(device_);
  const bool pushes = feeling_.profile().force_newton > 0;
  limit_->setEnabled(pushes);
  limit_->setRange(0.01, pushes ? feeling_.profile().force_newton : 0.01);
  limit_->setSingleStep(0.1);
  limit_->setValue(feeling_.max_force());
  device_->setCurrentIndex(device_->findData(feeling_.spelling()));
  if (QAction* feel = action("feel")) feel->setChecked(on);
}

void MainWindow::update_title() {
  setWindowTitle((document_.is_stale() ? tr("%1[*] — its text has errors — Sandpaper") : tr("%1[*] — Sandpaper"))
                     .arg(document_.title()));
  setWindowModified(document_.is_modified());
  if (document_.is_stale())
    statusBar()->showMessage(document_.contents().placed.empty()
                                 ? tr("The text has errors, and there is no version without")
                                 : tr("The text has errors: what is felt is the last version without"));
  else if (statusBar()->currentMessage().startsWith(tr("The text has errors")))
    statusBar()->clearMessage();
}

void MainWindow::update_actions() {
  const bool some = !document_.chosen().empty(), many = document_.chosen().size() > 1;
  for (const char* name :
       {"delete", "duplicate", "raise", "lower", "front", "back", "lock", "rename", "rectangle", "ellipse"})
    if (QAction* each = action(name)) each->setEnabled(some);
  for (const char* name : {"align_left", "align_right", "align_top", "align_bottom", "align_x", "align_y"})
    if (QAction* each = action(name)) each->setEnabled(many);
  if (QAction* rename = action("rename")) rename->setEnabled(document_.chosen().size() == 1);
  if (QAction* compare = action("compare")) compare->setEnabled(document_.chosen().size() == 2);
}

void MainWindow::update_description() {
  update_preview();
  if (const auto pair = chosen_pair()) {
    const auto& [a, b] = *pair;
    return description_->show_pair(tr("%1 and %2").arg(QString::fromStdString(a.called), QString::fromStdString(b.called)),
                                   a, b);
  }
  const auto shown = sliders_->shown();
  const Placed* placed = shown ? document_.contents().find(*shown) : nullptr;
  if (!placed) return description_->show_none(tr("Choose or touch a patch; of two chosen ones, their differences."), {});
  const QString name = QString::fromStdString(placed->patch.name + " = " + placed->patch.made_of);
  if (const wale::Program* program = feeling_.program(placed->id))
    return description_->show(name, exchange_->previewed(*placed, *program));
  const auto material = feeling_.material(placed->id);
  QString why = material ? QString() : tr("compiling …");
  if (material)
    for (const wale::Problem& each : material->problems)
      why += QString::fromStdString(wale::in_words(each.error)) + "\n";
  description_->show_none(name, why);
}

std::optional<std::pair<wale::PlacedProgram, wale::PlacedProgram>> MainWindow::chosen_pair() const {
  if (document_.chosen().size() != 2) return std::nullopt;
  std::vector<wale::PlacedProgram> two;
  for (const auto id : document_.chosen()) {
    const Placed* placed = document_.contents().find(id);
    const wale::Program* program = placed ? feeling_.program(id) : nullptr;
    if (program) two.push_back(exchange_->previewed(*placed, *program));
  }
  if (two.size() != 2) return std::nullopt;
  return std::pair(two[0], two[1]);
}

void MainWindow::update_preview() {
  const auto shown = sliders_->shown();
  const Placed* placed = shown ? document_.contents().find(*shown) : nullptr;
  const wale::Program* program = placed ? feeling_.program(placed->id) : nullptr;
  if (!program) return preview_->show({}, std::nullopt);
  preview_->show(QString::fromStdString(placed->patch.name + " = " + placed->patch.made_of),
                 exchange_->previewed(*placed, *program));
}

void MainWindow::touched_changed() {
  const auto touched = canvas_->touched();
  sliders_->set_touched(touched);
  const Placed* placed = touched ? document_.contents().find(*touched) : nullptr;
  palette_->set_touched(placed ? QString::fromStdString(placed->patch.made_of) : QString());
  if (!document_.is_stale() && panels_before_.isEmpty())
    statusBar()->showMessage(
        placed ? tr("on %1 = %2").arg(canvas_->label_of(*placed), QString::fromStdString(placed->patch.made_of))
               : QString());
}

void MainWindow::announce(const wale::Error& error) {
  QString words = QString::fromStdString(wale::in_words(error));
  const QString file = QString::fromStdString(error.place.name);
  if (!file.isEmpty() && !words.contains(file)) words = file + ": " + words;
  announcement_->say(words);
}

void MainWindow::offer_left_behind() {
  const auto left = Autosave::left_behind();
  if (!left) return;
  const QString name = left->file.isEmpty() ? tr("an unsaved workspace") : left->file;
  const QString words = tr("A window was closed by force. Its work on %1 from %2 was kept.")
                            .arg(name, left->time.toString(Qt::ISODate));
  announcement_->keep_offering(words, tr("Restore it"), [this, words, left = *left] {
    editor_->commit();
    when_saved(tr("restore what was kept"), [this, words, left] {
      announcement_->withdraw(words);
      if (!QFile::exists(left.kept_in))  // another window was faster
        return announcement_->say(tr("It was restored already."));
      document_.restore(left.file, left.text.toStdString());
      autosave_.save_now();
      Autosave::forget(left);
      announcement_->say(tr("Restored what was not saved, from %1. It is not saved yet.")
                             .arg(left.time.toString(Qt::ISODate)));
    });
  });
}

void MainWindow::show_page(const QString& page) {
  if (!pages_->open(page)) return;
  auto* dock = findChild<QDockWidget*>("dock_pages");
  if (!dock->isVisible()) {
    dock->show();
    auto* text = findChild<QDockWidget*>("dock_text");
    resizeDocks({text, dock}, {1, 1}, Qt::Horizontal);
    resizeDocks({dock}, {height() / 2}, Qt::Vertical);  // high enough to read
  }
  dock->raise();
  findChild<QWidget*>("page")->setFocus();
}

void MainWindow::seek_advice() {
  if (document_.is_stale() || document_.contents().placed.empty()) return;
  const std::string text = document_.text();
  const wale::WorkspaceOptions options{
      .device = programs_.device(),
      .workspace = document_.contents().name,
      .name = document_.file().isEmpty() ? "untitled.wale" : document_.file().toStdString()};
  advisor_.post(0, "advice", [this, text, options] {
    auto problems = language_.legibility(text, options);
    advice_.post([this, text, problems] { document_.set_advice({text, problems}); });
  });
}

bool MainWindow::open(const QString& file) {
  feeling_.set_on(false);
  if (is_picture(file)) {  // as if it were dropped
    take_dropped({file}, {0, 0});
    return true;
  }
  if (const auto opened = document_.open(file); !opened) {
    announce(opened.error());
    return false;
  }
  canvas_->show_all();
  feel_if_trusted();
  return true;
}

void MainWindow::closeEvent(QCloseEvent* event) {
  editor_->commit();
  if (!closes_anyway_ && document_.is_modified()) {
    event->ignore();
    when_saved(tr("close"), [this] {
      closes_anyway_ = true;
      close();
    });
    return;
  }
  feeling_.set_on(false);
  presenting_.end("the window was closed");
  if (participant_) participant_->close();
  QMainWindow::closeEvent(event);
}

bool MainWindow::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() != QEvent::KeyPress || !watched->isWidgetType()) return QMainWindow::eventFilter(watched, event);
  const auto* key = static_cast<QKeyEvent*>(event);
  auto* widget = static_cast<QWidget*>(watched);
  const bool is_space = key->key() == Qt::Key_Space && key->modifiers() == Qt::NoModifier;
  const qint64 now = QDateTime::currentMSecsSinceEpoch();
  const bool belongs_to_text = takes_text(widget) && now - last_typed_ < while_typing;
  if (takes_text(widget)) last_typed_ = now;
  if (feeling_.is_on() && ((is_space && !belongs_to_text) || key->key() == Qt::Key_Escape)) {
    feeling_.set_on(false);
    announcement_->say(no_force());
    return is_space || !takes_text(widget);  // a space that takes force away is not typed, too
  }
  return QMainWindow::eventFilter(watched, event);
}

}  // namespace sandpaper
