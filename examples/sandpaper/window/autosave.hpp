#pragma once

#include <QDateTime>
#include <QObject>
#include <QTimer>
#include <functional>
#include <optional>
#include <string>

#include "document/document.hpp"

namespace sandpaper {

/// Keeps what is not saved in a file of its own, at most a second after each change, so that a killed process loses no
/// more. The file is removed when the document is saved or the window closes properly. Each window has its own.
class Autosave : public QObject {
  Q_OBJECT

 public:
  Autosave(Document& document, QObject* parent = nullptr);
  ~Autosave() override;

  /// What a process that was killed has left.
  struct Left {
    QString kept_in;  ///< the autosave's own file
    QString file;     ///< the document's; may be empty
    QString text;
    QDateTime time;
  };
  static std::optional<Left> left_behind();
  static void forget(const Left& left);

  /// A text that is typed just now and that the document does not know yet; nothing where there is none.
  void set_typed(const std::function<std::optional<std::string>()>& typed) { typed_ = typed; }
  /// Something has changed.
  void changed();
  void save_now();

 signals:
  /// What is not saved cannot be kept, and why; once until it can be kept again.
  void failed(const QString& words);

 private:
  std::optional<std::string> to_keep() const;

  Document& document_;
  QString path_;
  QTimer timer_;
  std::function<std::optional<std::string>()> typed_ = [] { return std::nullopt; };
  bool is_failing_ = false;
};

}  // namespace sandpaper
