#include "canvas/page.hpp"

#include <QBuffer>
#include <QCoreApplication>
#include <QPainter>
#include <QPdfWriter>
#include <QPrinter>
#include <algorithm>
#include <cmath>

#include "canvas/surface_image.hpp"

namespace sandpaper {
namespace {

constexpr int per_inch = 300;
constexpr double edge = 15, paper_width = 210, paper_height = 297;  // mm, A4
constexpr double picture_height = 190;                              // mm, what the table leaves of the first page
constexpr int most_pixels = 500;                                    // of a surface's side
constexpr double most_in_all = 5e7;                                 // pixels, 4 bytes each
constexpr double row_height = 5.5;                                  // mm

QString tr(const char* text) { return QCoreApplication::translate("sandpaper", text); }

double dots(double mm) { return mm / 25.4 * per_inch; }

QString millimetres(double x) { return QString::number(std::round(1e4 * x) / 10); }

/// What a shape covers of its box, as an image for a mask.
QImage covered(const PagePatch& patch, QSize pixels) {
  const wale::Shape shape = patch.placed->patch.outline.stretched(glm::vec2(patch.size));
  QImage mask(pixels, QImage::Format_Alpha8);
  for (int row = 0; row < pixels.height(); ++row)
    for (int column = 0; column < pixels.width(); ++column)
      mask.scanLine(row)[column] =
          shape.contains({static_cast<float>(((column + 0.5) / pixels.width() - 0.5) * patch.size.x),
                          static_cast<float>((0.5 - (row + 0.5) / pixels.height()) * patch.size.y)})
              ? 255
              : 0;
  return mask;
}

/// The pixels of a patch's surface: one for two dots of paper, where it is that large.
QSize pixels_of(const PagePatch& patch, double scale) {
  const auto side = [&](double metres) {
    return std::clamp(static_cast<int>(dots(1000 * metres * scale) / 2), 1, most_pixels);
  };
  return {side(patch.size.x), side(patch.size.y)};
}

/// The surface of a patch, which is what takes time.
QImage image_of(const PagePatch& patch, QSize pixels) {
  const wale::LaidOutPatch& laid = patch.placed->patch;
  QImage image(pixels, QImage::Format_ARGB32_Premultiplied);
  image.fill(QColor(220, 220, 220));
  if (patch.program) {
    const wale::Bank bank(*patch.program, patch.parameters,
                          {static_cast<float>(patch.size.x), static_cast<float>(patch.size.y), 0});
    image = surface_image(bank, nullptr, glm::vec2(patch.size), laid.outline.stretched(glm::vec2(patch.size)), pixels,
                          Look::relief, colour_of(laid.made_of))
                .convertToFormat(QImage::Format_ARGB32_Premultiplied);
  }
  if (!laid.outline.is_rectangle()) {
    QPainter inside(&image);
    inside.setCompositionMode(QPainter::CompositionMode_DestinationIn);
    inside.drawImage(0, 0, covered(patch, pixels));
  }
  return image;
}

void draw_patch(QPainter& painter, const PagePatch& patch, const QImage& image, QRectF box) {
  const wale::LaidOutPatch& laid = patch.placed->patch;
  painter.drawImage(box, image);
  painter.setPen(QPen(Qt::darkGray, dots(0.15)));
  painter.setBrush(Qt::NoBrush);
  if (laid.outline.is_rectangle()) painter.drawRect(box);
  else if (laid.shape == "ellipse") painter.drawEllipse(box);
  painter.setPen(Qt::black);
  const QString name = QString::fromStdString(laid.name);
  QRectF place = box;
  if (!laid.outline.is_rectangle()) {
    const glm::dvec2 inside = inner_place(laid.outline, patch.size);
    place.translate(inside.x / patch.size.x * box.width(), -inside.y / patch.size.y * box.height());
  }
  const QRectF words = painter.boundingRect(place, Qt::AlignCenter, name);
  if (words.width() > box.width()) return;
  painter.fillRect(words, QColor(255, 255, 255, 190));
  painter.drawText(place, Qt::AlignCenter, name);
}

/// Where a patch lies and how large it is, in mm. A polygon and a mask are measured, to a millimetre: their file has no
/// size, and the place from which they are written can be far outside.
std::pair<QString, QString> extent_of(const PagePatch& patch) {
  const wale::LaidOutPatch& laid = patch.placed->patch;
  if (laid.outline.is_rectangle() || laid.shape == "ellipse")
    return {millimetres(laid.at.x) + ", " + millimetres(laid.at.y),
            millimetres(patch.size.x) + " × " + millimetres(patch.size.y)};
  const QImage mask = covered(patch, {most_pixels, most_pixels});
  int left = most_pixels, right = 0, top = most_pixels, bottom = 0;
  for (int row = 0; row < most_pixels; ++row)
    for (int column = 0; column < most_pixels; ++column)
      if (mask.constScanLine(row)[column] != 0) {
        left = std::min(left, column), right = std::max(right, column + 1);
        top = std::min(top, row), bottom = std::max(bottom, row + 1);
      }
  if (right <= left) return {};
  const glm::dvec2 pixel = 1000.0 / most_pixels * patch.size;
  const auto whole = [](double mm) { return QString::number(std::lround(mm)); };
  return {whole(1000 * laid.at.x + pixel.x * ((left + right) / 2.0 - most_pixels / 2.0)) + ", " +
              whole(1000 * laid.at.y - pixel.y * ((top + bottom) / 2.0 - most_pixels / 2.0)),
          whole(pixel.x * (right - left)) + " × " + whole(pixel.y * (bottom - top))};
}

void draw_scale_bar(QPainter& painter, QPointF from, double scale) {
  double bar = 0.001;  // m, a round length of 30 to 75 mm on paper
  for (int i = 0; bar * scale * 1000 < 30; ++i) bar *= i % 3 == 1 ? 2.5 : 2;
  painter.setPen(QPen(Qt::black, dots(0.4)));
  painter.drawLine(from, from + QPointF(dots(bar * scale * 1000), 0));
  const QString size = std::abs(scale - 1) < 1e-9 ? tr("true size") : tr("scaled by %1").arg(scale, 0, 'g', 3);
  painter.drawText(from + QPointF(0, -dots(1.5)), tr("%1 mm, %2").arg(std::round(bar * 1e4) / 10).arg(size));
}

constexpr double room = std::min(paper_width - 2 * edge, picture_height - 20);  // mm, for the workspace

/// How large the workspace is on paper: 1 is its true size.
double scale_of(const WorkspacePage& page) {
  // All that lies on the workspace, also what lies beyond the device's reach.
  double across = page.diameter;
  for (const PagePatch& each : page.patches)
    for (int axis = 0; axis < 2; ++axis)
      across = std::max(across, 2 * std::abs(each.placed->patch.at[axis]) + each.size[axis]);
  return across * 1000 <= room ? 1 : room / (across * 1000);
}

/// The surfaces of all patches. Nothing if `progress` ended it.
std::optional<std::vector<QImage>> images_of(const WorkspacePage& page, const std::function<bool(double)>& progress) {
  // Of thousands of patches that lie on each other, each has fewer, so that all fit into the memory.
  double all = 1, scale = scale_of(page);
  for (const PagePatch& each : page.patches) {
    const QSize pixels = pixels_of(each, scale);
    all += static_cast<double>(pixels.width()) * pixels.height();
  }
  scale *= std::min(1.0, std::sqrt(most_in_all / all));
  std::vector<QImage> images;
  for (const PagePatch& each : page.patches) {
    if (!progress(static_cast<double>(images.size()) / static_cast<double>(page.patches.size()))) return std::nullopt;
    images.push_back(image_of(each, pixels_of(each, scale)));
  }
  return progress(1) ? std::optional(std::move(images)) : std::nullopt;
}

/// Draws the pages on a device that was set up for them, in a resolution of 300 dots per inch without margins. False if
/// it does not take them. It takes no time and cannot be ended: a printer would print the half of it.
bool draw_pages(QPagedPaintDevice& device, const WorkspacePage& page, const std::vector<QImage>& images) {
  QPainter painter;
  if (!painter.begin(&device)) return false;
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  QFont font = painter.font();
  font.setPointSizeF(8);
  painter.setFont(font);
  QFont title = font;
  title.setPointSizeF(14);
  painter.setFont(title);
  painter.drawText(QPointF(dots(edge), dots(edge + 4)), QString::fromStdString(page.name));
  painter.setFont(font);

  const double scale = scale_of(page);
  const QPointF middle(dots(paper_width / 2), dots(edge + 10 + room / 2));
  const auto place = [&](double x, double y) {
    return middle + QPointF(dots(1000 * x * scale), -dots(1000 * y * scale));
  };
  painter.setPen(QPen(Qt::gray, dots(0.2)));
  painter.setBrush(Qt::NoBrush);
  const double reach = dots(500 * page.diameter * scale);
  painter.drawEllipse(middle, reach, reach);
  for (std::size_t i = 0; i < page.patches.size(); ++i) {
    const PagePatch& each = page.patches[i];
    const glm::dvec2 at = each.placed->patch.at, half = 0.5 * each.size;
    draw_patch(painter, each, images[i],
               QRectF(place(at.x - half.x, at.y + half.y), place(at.x + half.x, at.y - half.y)));
  }
  double top = edge + 10 + room + 10;
  draw_scale_bar(painter, QPointF(dots(edge), dots(top)), scale);

  // The table, over as many pages as it needs.
  top += 8;
  const double columns[] = {edge, edge + 45, edge + 120, edge + 150};
  const auto row = [&](const QStringList& cells) {
    for (int i = 0; i < cells.size(); ++i) {
      const double right = i == 3 ? paper_width - edge : columns[i + 1];
      const QRectF box(dots(columns[i]), dots(top), dots(right - columns[i] - 2), dots(row_height));
      painter.drawText(box, Qt::AlignLeft | Qt::AlignVCenter,
                       painter.fontMetrics().elidedText(cells[i], Qt::ElideRight, static_cast<int>(box.width())));
    }
    top += row_height;
  };
  const QStringList heading = {tr("patch"), tr("material"), tr("at, mm"), tr("size, mm")};
  painter.setPen(Qt::black);
  row(heading);
  for (std::size_t i = 0; i < page.patches.size(); ++i) {
    if (top + row_height > paper_height - edge) {
      device.newPage();
      top = edge;
      row(heading);
    }
    const PagePatch& each = page.patches[i];
    const wale::LaidOutPatch& laid = each.placed->patch;
    const auto [at, size] = extent_of(each);
    row({QString::fromStdString(laid.name),
         QString::fromStdString(laid.made_of) + (each.program ? QString() : tr(" (has an error)")), at, size});
  }
  return painter.end();
}

}  // namespace

bool print_pages(QPrinter& printer, const WorkspacePage& page, const std::function<bool(double)>& progress) {
  printer.setPageSize(QPageSize(QPageSize::A4));
  printer.setFullPage(true);
  printer.setResolution(per_inch);
  printer.setDocName(page.name.empty() ? QStringLiteral("Sandpaper") : QString::fromStdString(page.name));
  const auto images = images_of(page, progress);
  return images && draw_pages(printer, page, *images);
}

std::optional<QByteArray> pdf_of(const WorkspacePage& page, const std::function<bool(double)>& progress) {
  const auto images = images_of(page, progress);
  if (!images) return std::nullopt;
  QByteArray bytes;
  QBuffer buffer(&bytes);
  buffer.open(QIODevice::WriteOnly);
  QPdfWriter writer(&buffer);
  writer.setPageSize(QPageSize(QPageSize::A4));
  writer.setPageMargins(QMarginsF(0, 0, 0, 0));
  writer.setResolution(per_inch);
  writer.setTitle(QString::fromStdString(page.name));
  return draw_pages(writer, page, *images) ? std::optional(bytes) : std::nullopt;
}

}  // namespace sandpaper
