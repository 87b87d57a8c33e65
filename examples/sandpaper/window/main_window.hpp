#pragma once

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFileSystemWatcher>
#include <QMainWindow>
#include <QPushButton>
#include <wale/catalogue.hpp>
#include <wale/language_service.hpp>

#include "canvas/canvas.hpp"
#include "document/document.hpp"
#include "editor/text_editor.hpp"
#include "feeling/feeling.hpp"
#include "feeling/sound.hpp"
#include "panels/description_panel.hpp"
#include "panels/pages_panel.hpp"
#include "panels/palette_panel.hpp"
#include "panels/plot_panel.hpp"
#include "panels/preview_panel.hpp"
#include "panels/slider_panel.hpp"
#include "presenting/participant_window.hpp"
#include "presenting/presenting.hpp"
#include "presenting/session_panel.hpp"
#include "window/announcement.hpp"
#include "window/autosave.hpp"
#include "window/exchange.hpp"

namespace sandpaper {

/// The whole window. All parts are found by their object names: "canvas", "palette", "text", "announcement".
class MainWindow : public QMainWindow {
  Q_OBJECT

 public:
  /// Both must outlive the window.
  MainWindow(const wale::Library& library, const wale::LanguageService& language, QWidget* parent = nullptr);

  ~MainWindow() override;

  /// Opens a file and asks nothing: what was not saved before must have been dealt with.
  bool open(const QString& file);
  Document& document() { return document_; }
  Feeling& feeling() { return feeling_; }
  Presenting& presenting() { return presenting_; }
  Canvas& canvas() { return *canvas_; }
  Exchange& exchange() { return *exchange_; }
  bool is_busy() const {
    return work_->is_busy() || programs_.is_busy() || pictures_.is_busy() || description_->is_busy() ||
           preview_->is_busy() || advising_.isActive() || advisor_.waiting() > 0;
  }
  /// The action with that object name; null if there is none.
  QAction* action(const QString& name) const { return findChild<QAction*>(name); }

 protected:
  void closeEvent(QCloseEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  // actions.cpp
  QAction* add(QMenu* menu, const QString& name, const QString& text, const QKeySequence& key,
               const std::function<void()>& act);
  QAction* add_toggle(QMenu* menu, const QString& name, const QString& text, const QKeySequence& key, bool on,
                      const std::function<void(bool)>& act);
  void make_file_menu();
  void make_edit_menu();
  void make_view_menu();
  void make_feel_menu();
  void make_help_menu();

  // presenting_actions.cpp
  void make_present_menu();
  void make_sorting();
  void show_participant(bool shown);
  void update_presenting();

  // main_window.cpp
  void make_panels();
  void make_safety_bar();
  void update_title();
  void update_safety();
  static QString no_force();
  void update_actions();
  void update_description();
  /// The two chosen patches as they are felt; nothing unless there are two.
  std::optional<std::pair<wale::PlacedProgram, wale::PlacedProgram>> chosen_pair() const;
  void update_preview();
  void touched_changed();
  void announce(const wale::Error& error);
  void offer_left_behind();
  void show_page(const QString& page);
  void seek_advice();

  // files.cpp
  bool save();
  bool save_as();
  bool write(const QString& file);
  /// Notices what another program writes into the file.
  void watch();
  void follow_file();
  static bool is_picture(const QString& file);
  /// Goes on at once if nothing is unsaved; else offers to save first, without a box.
  void when_saved(const QString& what, const std::function<void()>& then);
  void open_asked();
  void place_material(const QString& spelling, glm::dvec2 at);
  void place_recipe(const QString& recipe, glm::dvec2 at);
  void take_dropped(const QStringList& files, glm::dvec2 at);
  void place_pictures(const QStringList& files, glm::dvec2 at, double millimetres_per_pixel);
  std::uint64_t place_picture(const QString& file, glm::dvec2 at, double millimetres_per_pixel);
  void feel_if_trusted();

  const wale::Library& library_;
  const wale::LanguageService& language_;
  Document document_;
  Numbers numbers_;
  Programs programs_;
  Feeling feeling_;
  Sound sound_;
  Presenting presenting_;
  Pictures pictures_;
  std::unique_ptr<wale::Catalogue> catalogue_;
  Autosave autosave_;

  Canvas* canvas_;
  QStackedWidget* pages_of_work_;  // the canvas, or the sorting table
  Announcement* announcement_;
  Question* question_;
  LongWork* work_;
  PalettePanel* palette_ = nullptr;
  SliderPanel* sliders_ = nullptr;
  DescriptionPanel* description_ = nullptr;
  TextEditor* editor_ = nullptr;
  PlotPanel* plots_ = nullptr;
  PreviewPanel* preview_ = nullptr;
  PagesPanel* pages_ = nullptr;
  QPushButton* force_button_ = nullptr;
  QComboBox* device_ = nullptr;
  QDoubleSpinBox* limit_ = nullptr;
  QLabel* place_ = nullptr;
  SortingPage* sorting_page_ = nullptr;
  SessionPanel* session_panel_ = nullptr;
  QByteArray panels_before_;  // which were open before a sort in this window
  ParticipantWindow* participant_ = nullptr;
  Exchange* exchange_ = nullptr;
  QTimer plotting_, advising_;
  QFileSystemWatcher watched_;
  QTimer written_elsewhere_;  // until whoever writes is done
  qint64 last_typed_ = 0;
  long lost_ = 0;  // ticks of this run without a device
  bool closes_anyway_ = false;
  HandOver advice_;
  WorkThread advisor_;  // the last member: its work uses the others
};

}  // namespace sandpaper
