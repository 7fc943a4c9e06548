#include "page.h"

#include <algorithm>
#include <cmath>

#include "base/encode.h"
#include "base/text.h"
#include "display/paint_view.h"
#include "paint/curve.h"
#include "report/plot.h"
#include "sketch/sketch_picture.h"
#include "studio/paint_json.h"

namespace goniochrome::tool {

namespace {

constexpr int kWidest = 720;  // pixels of a picture on the page

// The page has only neutral grays, so that the paints are its only color.
constexpr const char* kStyle = R"(
:root { font: 15px/1.45 system-ui, "DejaVu Sans", "Helvetica Neue", Arial, sans-serif; color: #1c1c1c; background: #dcdcdc; }
*, *::before, *::after { box-sizing: border-box; }
body { margin: 0; }
header { padding: 14px 24px; background: #ededed; border-bottom: 1px solid #bdbdbd; }
h1 { margin: 0; font-size: 21px; overflow-wrap: anywhere; }
header p { margin: 2px 0 0; font-size: 13px; color: #555; }
.frame { display: grid; grid-template-columns: minmax(0, 3fr) minmax(320px, 2fr); gap: 24px; padding: 20px 24px 48px; align-items: start; }
.board { position: sticky; top: 20px; columns: 2 260px; column-gap: 16px; }
figure { margin: 0 0 16px; padding: 8px 8px 4px; background: #f6f6f6; border: 1px solid #bdbdbd; border-radius: 6px; break-inside: avoid; }
figure div { position: relative; }
figure img, .paint img { display: block; width: 100%; height: auto; }
figure svg { position: absolute; inset: 0; width: 100%; height: 100%; overflow: visible; }
figcaption { padding: 4px 2px; font-size: 13px; color: #555; overflow-wrap: anywhere; }
circle { fill: none; vector-effect: non-scaling-stroke; }
.tag { position: absolute; transform: translate(10px, -50%); padding: 1px 6px; border-radius: 9px; font-size: 11.5px; white-space: nowrap;
  background: rgba(255, 255, 255, .88); border: 1px solid rgba(0, 0, 0, .4); }
.tag.left { transform: translate(calc(-100% - 10px), -50%); }
.paint { margin: 0 0 18px; background: #f6f6f6; border: 1px solid #bdbdbd; border-radius: 8px; overflow: hidden; }
.paint .text { padding: 10px 14px 12px; }
h2 { margin: 0 0 6px; font-size: 17px; overflow-wrap: anywhere; }
.strip { display: block; height: 26px; }
table { width: 100%; border-collapse: collapse; font-size: 13.5px; }
th, td { padding: 3px 0; text-align: left; font-weight: 400; border-top: 1px solid #d8d8d8; font-variant-numeric: tabular-nums; }
th { color: #555; }
td.number { text-align: right; }
.swatch { display: inline-block; width: 14px; height: 14px; margin-right: 7px; border: 1px solid rgba(0, 0, 0, .35); border-radius: 3px; vertical-align: -2px; }
.note { margin: 6px 0 0; font-size: 12.5px; color: #555; }
@media (max-width: 800px) { .frame { grid-template-columns: minmax(0, 1fr); padding: 14px; } .board { position: static; columns: 1; } }
@media print { :root { background: #fff; } }
)";

std::string embedded(const std::string& png) {
  return "data:image/png;base64," + base64(png);
}

// The signal of each channel on an sRGB display. Light outside its gamut is mixed with its gray.
color::Rgb signals(const color::Rgb& light) {
  const color::Rgb shown = color::rec709_from_rec2020(display::in_display_gamut(light));
  return {display::srgb_signal(shown.x), display::srgb_signal(shown.y), display::srgb_signal(shown.z)};
}

std::string css_color(const color::Lab& lab) {
  return display::css_color(lab, *color::white_point({}));
}

// A dropper as two rings, which show on light and on dark, and a tag with the paint's name.
std::string dropper_marks(const PageImage& image, const std::vector<PageOfPaint>& paints) {
  const double width = image.content.image.width, height = image.content.image.height;
  std::string rings, tags;
  for (const PageOfPaint& paint : paints)
    for (const auto& [kind, sample] : paint.samples) {
      if (sample.dropper.image != image.image.name) continue;
      const double x = sample.dropper.x + 0.5, y = sample.dropper.y + 0.5;
      const double radius = std::max(sample.dropper.radius + 0.5, 0.012 * width);
      for (const char* stroke : {"#fff\" stroke-width=\"4", "#000\" stroke-width=\"1.6"})
        rings += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" stroke=\"{}\"/>", x, y, radius, stroke);
      tags += fmt::format("<span class=\"tag{}\" style=\"left:{:.2f}%;top:{:.2f}%\">{} {}</span>",
                          x > 0.6 * width ? " left" : "", 100 * x / width, 100 * y / height,
                          xml_escaped(paint.picked.paint.name, ""), kind);
    }
  return fmt::format("<svg viewBox=\"0 0 {:.0f} {:.0f}\" preserveAspectRatio=\"none\" aria-hidden=\"true\">{}</svg>{}",
                     width, height, rings, tags);
}

// One digit after the point, and no minus before zero.
std::string figure(double value) {
  const std::string text = fmt::format("{:.1f}", value);
  return text == "-0.0" ? "0.0" : text;
}

std::string color_row(const char* name, const color::Lab& lab) {
  return fmt::format(
      "<tr><th scope=\"row\"><span class=\"swatch\" style=\"background:{}\"></span>{}</th>"
      "<td class=\"number\">L* {}</td><td class=\"number\">a* {}</td><td class=\"number\">b* {}</td></tr>",
      css_color(lab), name, figure(lab.L), figure(lab.a), figure(lab.b));
}

// The border of a palette's color, whose gray is the gloss: evenly from black for 0 to white for 100 gloss units.
std::string gloss_border(const paint::Paint& paint) {
  if (paint.gloss.empty()) return "6px dashed #808080";
  const auto gray = std::lround(2.55 * std::clamp(paint.gloss.front().gloss_units, 0.0, 100.0));
  return fmt::format("6px solid #{0:02x}{0:02x}{0:02x}", gray);
}

// The address at which the studio starts from the paint. The studio shows by which commands the paint is made.
std::string studio_address(const paint::Paint& paint, const StudioLink& studio) {
  const Json design = {
      {"file", "picked.paints.xml"}, {"board", plain_utf8(studio.board)}, {"paint", studio::paint_json(paint)}};
  return percent_encoded(studio.address, "/") + "#design=" + percent_encoded(json_text(design));
}

std::string paint_card(const PageOfPaint& paint, const StudioLink& studio) {
  const paint::Paint& p = paint.picked.paint;
  const paint::Appearance& a = *p.appearance;
  std::string stops;
  for (int angle = 15; angle <= 110; angle += 5)
    stops +=
        fmt::format("{}{} {:.1f}%", stops.empty() ? "" : ",", css_color(paint::lab_at(a, angle)), (angle - 15) / 0.95);
  std::string text = fmt::format(
      "<article class=\"paint\"><img alt=\"{0}, drawn\" src=\"{1}\">"
      "<span class=\"strip\" title=\"color from 15 to 110 degrees from specular; the border shows the gloss at 60 "
      "degrees, "
      "black for 0 and white for 100 units, and is dashed where it was not picked\" "
      "style=\"background:linear-gradient(90deg,{2});border:{3}\"></span>"
      "<div class=\"text\"><h2>{0}</h2><table>",
      xml_escaped(p.name, ""), embedded(paint.picture), stops, gloss_border(p));
  text += color_row("Face", a.face) + color_row("Flop", a.flop);
  text += fmt::format("<tr><th scope=\"row\">Travel</th><td class=\"number\" colspan=\"3\">{:.0f}&deg;</td></tr>",
                      a.travel_deg);
  const std::string gloss = p.gloss.empty() ? "not picked" : fmt::format("{:.0f} GU", p.gloss.front().gloss_units);
  text += fmt::format(
      "<tr><th scope=\"row\">Gloss at 60&deg;</th><td class=\"number\" colspan=\"3\">{}</td></tr></table>", gloss);
  if (paint.picked.swapped) text += "<p class=\"note\">Face and flop traded places: the flop was the lighter one.</p>";
  if (!studio.address.empty())
    text += fmt::format("<p class=\"note\"><a href=\"{}\">Open in the studio</a></p>", studio_address(p, studio));
  return text + "</div></article>\n";
}

}  // namespace

Result<std::string> shown_png(const PageImage& image, int step) {
  GONIO_ASSIGN(const sketch::Picture picture,
               sketch::picture_of(image.content, image.image.path, sketch::PictureView::kShown));
  const image::Image& from = picture.rgb;
  image::Image to{(from.width + step - 1) / step, (from.height + step - 1) / step, 3, {}, {}};
  for (int y = 0; y < to.height; ++y)
    for (int x = 0; x < to.width; ++x) {
      color::Rgb sum;
      double count = 0;
      for (int j = y * step; j < std::min((y + 1) * step, from.height); ++j)
        for (int i = x * step; i < std::min((x + 1) * step, from.width); ++i, ++count) {
          const float* p = from.pixel(i, j);
          sum += {p[0], p[1], p[2]};
        }
      const color::Rgb s = signals((1 / count) * sum);
      for (int c = 0; c < 3; ++c) to.data.push_back(static_cast<float>(s[c]));
    }
  return image::png_content(image.image.path, to);
}

Result<std::string> board_page(const sketch::Board& board, const std::vector<PageImage>& images,
                               const std::vector<PageOfPaint>& paints, const std::string& lit_by,
                               const StudioLink& studio) {
  const std::string title = xml_escaped(board.title.empty() ? "Mood board" : board.title, "");
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"generator\" content=\"Goniochrome "
      "paint-pick\">\n<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n"
      "<header><h1>{0}</h1><p>{2} picture{3}, {4} paint{5}, drawn {6}</p></header>\n<div class=\"frame\">\n"
      "<section class=\"board\" aria-label=\"Pictures\">\n",
      title, kStyle, images.size(), images.size() == 1 ? "" : "s", paints.size(), paints.size() == 1 ? "" : "s",
      xml_escaped(lit_by, ""));
  for (const PageImage& image : images) {
    GONIO_ASSIGN(const std::string png, shown_png(image, (image.content.image.width + kWidest - 1) / kWidest));
    page += fmt::format("<figure><div><img alt=\"{0}\" src=\"{1}\">{2}</div><figcaption>{0}</figcaption></figure>\n",
                        xml_escaped(image.image.name, ""), embedded(png), dropper_marks(image, paints));
  }
  page += "</section>\n<main>\n";
  for (const PageOfPaint& paint : paints) page += paint_card(paint, studio);
  return page + "</main>\n</div>\n</body>\n</html>\n";
}

}  // namespace goniochrome::tool
