#pragma once

#include <QDateTime>
#include <QObject>
#include <QTimer>
#include <optional>

#include "document/document.hpp"

namespace sandpaper {

/// Keeps what is not saved in a file of its own, at most a second after each change, so that a killed process loses no
/// more. The file is removed when the document is saved or the window closes properly.
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

  void save_now();

 private:
  Document& document_;
  QString path_;
  QTimer timer_;
};

}  // namespace sandpaper
