#pragma once

#include <QFrame>
#include <QLabel>
#include <QPushButton>
#include <functional>
#include <vector>

class QHBoxLayout;

namespace sandpaper {

/// A line of fields that asks for numbers, where others would open a box. Enter answers it, Escape puts it away.
class Question : public QFrame {
  Q_OBJECT

 public:
  struct Field {
    QString label, unit;  ///< "width", "mm"
    double value = 0, least = 0, most = 0;
    int decimals = 2;
    QStringList choices = {};  ///< one of these, by its number from 0, instead
  };

  explicit Question(QWidget* parent = nullptr);

  /// Asks; a question that is open is put away. `answered` gets one number for each field.
  void ask(const QString& words, const std::vector<Field>& fields, const QString& button,
           const std::function<void(const std::vector<double>&)>& answered);
  /// Answers with what stands in the fields.
  void answer();

 protected:
  void keyPressEvent(QKeyEvent* event) override;

 private:
  QLabel* words_;
  QHBoxLayout* row_;
  QPushButton* button_;
  std::vector<QWidget*> labels_;
  std::vector<QWidget*> numbers_;  // fields of numbers and of choices
  std::function<void(const std::vector<double>&)> answered_;
};

}  // namespace sandpaper
