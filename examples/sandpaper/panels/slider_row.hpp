#pragma once

#include <QDoubleSpinBox>
#include <QLabel>
#include <QLineEdit>
#include <QSlider>
#include <QToolButton>
#include <QWidget>
#include <optional>
#include <string>
#include <wale/patch_program.hpp>

namespace sandpaper {

/// A slider, with the range of its marks drawn over it.
class MarkedSlider : public QSlider {
  Q_OBJECT

 public:
  static constexpr int steps = 1000;

  explicit MarkedSlider(QWidget* parent = nullptr);
  /// Shares of the slider's way, 0 .. 1.
  void set_marks(std::optional<double> low, std::optional<double> high);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  std::optional<double> low_, high_;
};

/// One slider with its name, its exact number, its marks and a button that resets it. Values are in SI.
class SliderRow : public QWidget {
  Q_OBJECT

 public:
  /// `default_value` is what the reset gives.
  SliderRow(const wale::Parameter& parameter, bool is_percept, float value, float default_value,
            QWidget* parent = nullptr);

  const std::string& name() const { return parameter_.name; }
  const wale::Parameter& parameter() const { return parameter_; }
  bool is_percept() const { return is_percept_; }
  float value() const { return value_; }
  /// Shows a value that something else has set.
  void set_value(float value);
  void set_marks(std::optional<float> low, std::optional<float> high, const QString& says);

 signals:
  /// Someone moves the slider; `is_final` when it is let go or a number is entered.
  void moved(float value, bool is_final);
  void reset_wanted();
  /// Marks the present value as the low or the high end.
  void mark_wanted(bool high);
  void unmark_wanted();
  /// Someone wrote what it still feels like within the marks.
  void says_wanted(const QString& says);

 private:
  int step_of(float value) const;
  void show_value();

  wale::Parameter parameter_;
  bool is_percept_;
  float value_, default_;
  QLabel* name_;
  MarkedSlider* slider_;
  QDoubleSpinBox* number_;
  QToolButton* reset_;
  QToolButton* mark_;
  QLineEdit* says_;  // only where there is a mark
};

}  // namespace sandpaper
