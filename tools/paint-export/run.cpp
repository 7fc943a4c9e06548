#include <algorithm>
#include <filesystem>
#include <optional>
#include <span>

#include "base/clock.h"
#include "base/file.h"
#include "base/file_names.h"
#include "base/parallel.h"
#include "base/text.h"
#include "formats/batches.h"
#include "materials/material.h"
#include "paint_stream.h"
#include "table_output.h"
#include "tool.h"

namespace goniochrome::tool {

namespace {

constexpr std::string_view kName = "{name}";

const materials::Target& target_of(const std::string& name) {
  const auto& all = materials::targets();
  return **std::ranges::find(all, name, [](const materials::Target* target) { return std::string(target->name); });
}

Json json_of(const paint::Paint& paint, const materials::Target& target, const std::string& file,
             const std::string& companion, const materials::Shown& shown, const std::vector<std::string>& left_out) {
  Json by_geometry = Json::object();
  for (const auto& [geometry, de00] : shown.by_geometry)
    by_geometry[paint::geometry_name(geometry)] = json_number(de00);
  return {{"name", paint.name},
          {"target", target.name},
          {"file", file},
          {"companion", companion.empty() ? Json(nullptr) : Json(companion)},
          {"de00_mean", json_number(shown.de00_mean)},
          {"de00_max", json_number(shown.de00_max)},
          {"de00_by_geometry", std::move(by_geometry)},
          {"readings_de00_mean", shown.readings_de00_mean ? json_number(*shown.readings_de00_mean) : Json(nullptr)},
          {"left_out", left_out}};
}

// One run over all paints.
class Run {
 public:
  Run(const Options& options, cli::Session& session)
      : options_(options), session_(session), target_(target_of(options.to)) {
    session.begin_list("paints");
  }

  Result<cli::Verdict> all() {
    GONIO_ASSIGN(formats::PaintBatches paints, formats::PaintBatches::open(options_.inputs));
    if (options_.output != "-") {
      GONIO_ASSIGN(OutputFile opened, OutputFile::create("-"));
      table_.emplace(std::move(opened));
    }
    GONIO_TRY(tell("name\tfile\tde00_mean\tde00_max\treadings\n"));
    const auto left_out = [&](const Error& error) { leave_out(error); };
    const auto keep_going = options_.keep_going ? std::function<void(const Error&)>(left_out) : nullptr;
    const auto in_parts = [&](const std::vector<paint::Paint>& batch) -> Result<void> {
      for (std::size_t from = 0; from < batch.size(); from += target_.at_once)
        GONIO_TRY(take(std::span(batch).subspan(from, std::min(target_.at_once, batch.size() - from))));
      return {};
    };
    GONIO_TRY(for_each_batch(paints, session_, in_parts, keep_going));
    if (table_) GONIO_TRY(table_->commit());
    return finish();
  }

 private:
  // Makes the files of some paints side by side, then writes them in order.
  Result<void> take(std::span<const paint::Paint> paints) {
    const Stopwatch clock;
    std::vector<materials::Naming> names(paints.size());
    for (std::size_t i = 0; i < paints.size(); ++i) {
      names[i] = {identifiers_.of(paints[i].name), plain_utf8(paints[i].name), plain_utf8(session_.provenance()), {}};
      names[i].file_stem = std::filesystem::path(pattern_with(names[i].identifier)).stem().string();
    }
    std::vector<std::optional<Result<materials::Material>>> made(paints.size());
    parallel_for(paints.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) made[i].emplace(target_.material(paints[i], names[i]));
    });
    for (std::size_t i = 0; i < paints.size(); ++i) {
      if (made[i]->ok()) {
        GONIO_TRY(write(paints[i], names[i], **made[i]));
      } else {
        if (!options_.keep_going) return made[i]->error();
        leave_out(made[i]->error());
      }
    }
    work_s_ += clock.elapsed_s();
    return table_ ? table_->flush() : Result<void>();
  }

  // A line of the table, which gives way to the file of a paint on standard output.
  Result<void> tell(const std::string& line) { return table_ ? table_->write(line) : Result<void>(); }

  Result<void> write(const paint::Paint& paint, const materials::Naming& naming, const materials::Material& material) {
    GONIO_ASSIGN(const std::string file, file_of(paint, naming.identifier));
    GONIO_TRY(write_file(file, material.bytes));
    const std::string companion = target_.companion ? companion_of(file) : std::string();
    if (target_.companion) GONIO_TRY(write_file(companion, material.companion));
    std::vector<std::string> left_out = materials::left_out(paint, target_);
    left_out.insert(left_out.end(), material.left_out.begin(), material.left_out.end());
    for (const std::string& what : left_out)
      session_.warn(fmt::format("{}: {} is left out: {} has no place for it", paint.name, what, target_.name));
    const materials::Shown& shown = material.shown;
    ++written_;
    sum_ += shown.de00_mean;
    worst_ = std::max(worst_, shown.de00_max);
    session_.add("paints", [&] { return json_of(paint, target_, file, companion, shown, left_out); });
    return tell(fmt::format(
        "{}\t{}\t{:.3f}\t{:.3f}\t{}\n", table_field(paint.name), table_field(file), shown.de00_mean, shown.de00_max,
        shown.readings_de00_mean ? fmt::format("{:.3f}", *shown.readings_de00_mean) : std::string("n/a")));
  }

  // The pattern with the identifier in it; the ending is added where it stops there.
  Result<std::string> file_of(const paint::Paint& paint, const std::string& identifier) const {
    if (options_.output.find(kName) == std::string::npos && written_ > 0)
      return usage_error("--output {}: \"{}\" would be written over the paint before it: put {{name}} into the pattern",
                         options_.output, paint.name);
    return pattern_with(identifier);
  }

  std::string pattern_with(const std::string& identifier) const {
    std::string file = options_.output;
    if (file.ends_with(kName)) file += target_.ending;
    for (auto at = file.find(kName); at != std::string::npos; at = file.find(kName, at + identifier.size()))
      file.replace(at, kName.size(), identifier);
    return file;
  }

  // The second file stands beside the first, under the same name with an ending of its own.
  std::string companion_of(const std::string& file) const {
    return std::filesystem::path(file).replace_extension().string() + target_.companion;
  }

  void leave_out(const Error& error) {
    session_.warn(error.message);
    ++left_out_;
  }

  cli::Verdict finish() {
    Json& results = session_.results();
    results["written"] = written_;
    results["left_out"] = left_out_;
    results["de00_mean"] = written_ > 0 ? json_number(sum_ / static_cast<double>(written_)) : Json(nullptr);
    results["paints_per_s"] = work_s_ > 0 ? static_cast<double>(written_) / work_s_ : 0;
    std::string line = fmt::format("{}: {} paints written for {}", session_.tool(), written_, target_.name);
    if (written_ > 0)
      line += fmt::format(", dE00 mean {:.2f}, worst {:.2f}", sum_ / static_cast<double>(written_), worst_);
    if (left_out_ > 0) line += fmt::format(", {} left out", left_out_);
    session_.say(line);
    if (written_ + left_out_ == 0) session_.warn("the input holds no paints: nothing was exported");
    return left_out_ > 0 || written_ == 0 ? cli::Verdict::kNegative : cli::Verdict::kDone;
  }

  const Options& options_;
  cli::Session& session_;
  const materials::Target& target_;
  materials::Identifiers identifiers_;
  std::optional<OutputFile> table_;
  std::size_t written_ = 0, left_out_ = 0;
  double sum_ = 0, worst_ = 0, work_s_ = 0;
};

}  // namespace

Result<cli::Verdict> run(const Options& options, cli::Session& session) {
  if (options.output.empty())
    return usage_error("--output is empty: give a pattern such as 'materials/{{name}}', or - for standard output");
  GONIO_TRY(FileNames::check(options.output, {"name"}, "--output"));
  const materials::Target& target = target_of(options.to);
  if (options.output == "-" && target.companion)
    return usage_error("--output -: a material for {} has two files: give a pattern such as '{{name}}'", target.name);
  if (target.companion && options.output.ends_with(target.companion))
    return usage_error("--output {}: {} is the ending of the second file, which stands beside the first one",
                       options.output, target.companion);
  session.explain(fmt::format("target {}: {}\nleft out: flakes, color maps and anisotropy, which it has no place for\n",
                              target.name, target.what));
  return Run(options, session).all();
}

}  // namespace goniochrome::tool
