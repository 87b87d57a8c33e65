#pragma once

#include <QLabel>
#include <QPlainTextEdit>
#include <QTableWidget>
#include <map>
#include <memory>
#include <wale/language_service.hpp>

#include "feeling/work_thread.hpp"

namespace sandpaper {

/// What a material feels like, percept by percept: asked, reads, evidence. In the window's thread.
class DescriptionPanel : public QWidget {
  Q_OBJECT

 public:
  explicit DescriptionPanel(const wale::LanguageService& language, QWidget* parent = nullptr);

  /// Shows a program, which is read in the background; null for none, with the reason.
  void show(const QString& name, const wale::Program* program, const QString& why_none = {});
  bool is_busy() const { return thread_.waiting() > 0; }

 private:
  using Told = std::shared_ptr<const wale::Result<wale::ToldMaterial>>;
  void fill(const Told& told);

  const wale::LanguageService& language_;
  QLabel* title_;
  QTableWidget* percepts_;
  QPlainTextEdit* text_;
  const void* shown_ = nullptr;
  std::map<const void*, std::pair<wale::Program, Told>> known_;
  WorkThread thread_;  // the last member: its work uses the others
};

}  // namespace sandpaper
