#pragma once

#include <QLabel>
#include <QPlainTextEdit>
#include <QTableWidget>
#include <map>
#include <memory>
#include <wale/language_service.hpp>

#include "feeling/hand_over.hpp"
#include "feeling/work_thread.hpp"

namespace sandpaper {

/// What a patch feels like, percept by percept: asked, reads, evidence; or which differences between two patches people
/// notice. Programs are read in the background. In the window's thread.
class DescriptionPanel : public QWidget {
  Q_OBJECT

 public:
  explicit DescriptionPanel(const wale::LanguageService& language, QWidget* parent = nullptr);

  /// Shows a patch as it is felt.
  void show(const QString& name, const wale::PlacedProgram& patch);
  /// Shows how two patches differ.
  void show_pair(const QString& names, const wale::PlacedProgram& a, const wale::PlacedProgram& b);
  /// Shows that nothing is known, and why.
  void show_none(const QString& name, const QString& why);
  bool is_busy() const { return is_reading_; }

 private:
  /// What was read: the same for the same programs, values and sizes.
  struct Told {
    QString text;
    std::vector<wale::ToldPercept> percepts;
    std::vector<wale::Program> of;  // they live as long as the key, which has their addresses
    bool names_itself = false;  ///< its first line is the material's name, in whose place the patch has its own
  };
  using ToldRef = std::shared_ptr<const Told>;
  void show_read(const QString& name, const std::string& key, const void* program, std::function<Told()> read);
  void fill(const Told& told);

  const wale::LanguageService& language_;
  QLabel* title_;
  QTableWidget* percepts_;
  QPlainTextEdit* text_;
  bool is_reading_ = false;       // what is shown now
  std::string shown_;             // the key of what is shown or being read
  const void* program_ = nullptr;  // the program that is shown: while its values change, the old text stays
  std::map<std::string, ToldRef> known_;
  HandOver window_;
  WorkThread thread_;  // the last member: its work uses the others
};

}  // namespace sandpaper
