#include "library/index.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>

#include "base/clock.h"
#include "base/file.h"
#include "base/json.h"
#include "base/parallel.h"
#include "base/text.h"
#include "formats/paint_source.h"
#include "formats/reference.h"
#include "paint/curve.h"

namespace goniochrome::library {

namespace {

// The file: this head, then arrays at multiples of 64 bytes in the machine's own number format, then a directory in
// JSON that says what stands where. Another machine's byte order makes another magic number.
struct Head {
  std::uint64_t magic = 0x0350414e534e4f47;  // "GONSNAP" and the version of the format
  std::uint64_t sum = 0;                     // of everything behind this number
  std::uint64_t file_bytes = 0, directory_at = 0, directory_bytes = 0;
};

constexpr std::uint64_t kEmptySum = 0xcbf29ce484222325;

// A 64-bit sum goes on over bytes: words are mixed in by multiplication (FNV's prime) and rotation, the last one filled
// up by zeros. Each step is one-to-one, so that no change of one word is lost. Guards against accidents, not malice.
std::uint64_t summed(std::uint64_t sum, std::string_view bytes) {
  for (std::size_t at = 0; at < bytes.size(); at += sizeof sum) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, std::min(sizeof word, bytes.size() - at));
    sum = (sum ^ word) * 0x100000001b3;
    sum = (sum << 27) | (sum >> 37);
  }
  return sum;
}

// The sum that the head of an index states.
std::uint64_t sum_of_index(std::string_view bytes) {
  return summed(kEmptySum, bytes.substr(offsetof(Head, file_bytes)));
}

// The metrics that an index keeps.
std::span<const paint::MetricColumn> columns() {
  return paint::metric_columns_without_fit();
}

// The guard distinguishes states of a library file. A program can set the time of modification back, but not that of
// the last change.
struct Guard {
  std::uint64_t bytes = 0;
  std::int64_t changed_ns = 0;
};

Result<Guard> guard_of(const std::string& path) {
  struct stat info{};
  if (stat(path.c_str(), &info) != 0) return input_error("{}: cannot be read: {}", path, std::strerror(errno));
  if (!S_ISREG(info.st_mode))
    return input_error("{}: is no plain file: a library is kept with its index beside it, so give a file", path);
  return Guard{static_cast<std::uint64_t>(info.st_size),
               static_cast<std::int64_t>(info.st_ctim.tv_sec) * 1'000'000'000 + info.st_ctim.tv_nsec};
}

std::vector<std::string> warnings_of(const formats::PaintSource& source) {
  std::vector<std::string> lines = source.warnings();
  std::ranges::move(source.closing_warnings(), std::back_inserter(lines));
  return lines;
}

}  // namespace

// The bytes of an index, mapped from a file or owned.
class LibraryIndex::Bytes {
 public:
  explicit Bytes(std::string owned) : owned_(std::move(owned)), data_(owned_.data()), size_(owned_.size()) {}
  static std::unique_ptr<Bytes> mapped(const std::string& path) {
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (fd < 0) return nullptr;
    struct stat info{};
    void* data = MAP_FAILED;
    if (fstat(fd, &info) == 0 && S_ISREG(info.st_mode) && info.st_size > 0)
      data = mmap(nullptr, static_cast<std::size_t>(info.st_size), PROT_READ, MAP_SHARED, fd, 0);
    close(fd);
    if (data == MAP_FAILED) return nullptr;
    auto bytes = std::make_unique<Bytes>("");
    bytes->data_ = static_cast<const char*>(data);
    bytes->size_ = static_cast<std::size_t>(info.st_size);
    bytes->is_mapped_ = true;
    return bytes;
  }
  Bytes(const Bytes&) = delete;
  Bytes& operator=(const Bytes&) = delete;
  ~Bytes() {
    if (is_mapped_) munmap(const_cast<char*>(data_), size_);
  }
  const char* data() const { return data_; }
  std::size_t size() const { return size_; }
  std::string_view view() const { return {data_, size_}; }

 private:
  std::string owned_;
  const char* data_;
  std::size_t size_;
  bool is_mapped_ = false;
};

namespace {

// The sum of a file's content.
Result<std::uint64_t> checksum(const std::string& path) {
  std::FILE* stream = std::fopen(path.c_str(), "rb");
  if (!stream) return input_error("{}: cannot be read: {}", path, std::strerror(errno));
  std::string buffer(1 << 19, '\0');
  std::uint64_t sum = kEmptySum;
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), stream))
    sum = summed(sum, std::string_view(buffer).substr(0, count));
  std::fclose(stream);
  return sum;
}

// Packs arrays one after another into the bytes of a file; add() returns where each of them begins.
class Packer {
 public:
  // `expected_bytes`: about what will be added.
  explicit Packer(std::size_t expected_bytes) {
    bytes_.reserve(expected_bytes);
    bytes_.resize(sizeof(Head));
  }

  template <class T>
  std::uint64_t add(const std::vector<T>& values) {
    return add(std::string_view(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)));
  }
  std::uint64_t add(std::string_view raw) {
    bytes_.resize((bytes_.size() + 63) / 64 * 64);
    const std::uint64_t at = bytes_.size();
    bytes_.append(raw);
    return at;
  }
  std::string finish(const Json& directory) {
    const std::string text = json_text(directory);
    Head head;
    head.directory_at = add(text);
    head.directory_bytes = text.size();
    head.file_bytes = bytes_.size();
    std::memcpy(bytes_.data(), &head, sizeof head);
    head.sum = sum_of_index(bytes_);
    std::memcpy(bytes_.data(), &head, sizeof head);
    return std::move(bytes_);
  }

 private:
  std::string bytes_;
};

struct SectionKey {
  color::ViewingCondition condition;
  std::vector<paint::Geometry> geometries;
  friend bool operator<(const SectionKey& x, const SectionKey& y) {
    const auto order = std::tie(x.condition.illuminant, x.condition.observer_deg) <=>
                       std::tie(y.condition.illuminant, y.condition.observer_deg);
    if (order != 0) return order < 0;
    return std::ranges::lexicographical_compare(x.geometries, y.geometries, geometry_order);
  }
};

struct SectionRows {
  std::vector<double> rows;
  std::vector<std::uint32_t> labels;
};

// Gathers the paints of a library and packs them into an index.
class Builder {
 public:
  // Computes what the paints of a batch need on all cores, then takes them in their order.
  Result<void> add(std::span<const paint::Paint> batch) {
    std::vector<std::optional<Result<paint::PaintMetrics>>> numbers(batch.size());
    parallel_for(batch.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) numbers[i] = paint::metrics(batch[i], paint::CurveFit::kWhereNeeded);
    });
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (texts_.size() + batch[i].name.size() + batch[i].code.size() > UINT32_MAX)
        return input_error("the names and codes of a library take at most 4 GB");
      if (!numbers[i]->ok()) return input_error("paint \"{}\": {}", batch[i].name, numbers[i]->error().message);
      add(batch[i], numbers[i]->value());
    }
    return {};
  }

  std::size_t size() const { return classes_.size(); }

  std::string pack(Json directory) {
    // Colors, boxes and the rest as they are in memory now, and a little for padding.
    std::size_t bytes = 4096 + texts_.size() + size() * (4 * sizeof(std::uint32_t) + sizeof(double) * columns().size());
    for (const auto& [key, rows] : sections_) bytes += rows.rows.size() * sizeof(double) * 9 / 8;
    Packer packer(bytes);
    directory["paints"] = size();
    directory["offsets"] = packer.add(offsets_);
    directory["texts"] = packer.add(std::string_view(texts_));
    directory["text_bytes"] = texts_.size();
    directory["classes"] = packer.add(classes_);
    Json kept = Json::array();
    for (std::size_t i = 0; i < metrics_.size(); ++i) {
      kept.push_back({{"name", columns()[i].name}, {"at", packer.add(metrics_[i])}});
      metrics_[i] = {};
    }
    directory["metrics"] = kept;
    directory["sections"] = Json::array();
    for (auto& [key, rows] : sections_) {
      const std::size_t channels = 3 * key.geometries.size();
      const Tree tree = build_tree(rows.rows, channels, rows.labels);
      rows = {};
      Json names = Json::array();
      for (const paint::Geometry& geometry : key.geometries) names.push_back(paint::geometry_name(geometry));
      directory["sections"].push_back({{"illuminant", key.condition.illuminant},
                                       {"observer_deg", key.condition.observer_deg},
                                       {"geometries", names},
                                       {"paints", tree.size},
                                       {"blocks", packer.add(tree.blocks)},
                                       {"boxes", packer.add(tree.boxes)},
                                       {"labels", packer.add(tree.labels)}});
    }
    return packer.finish(directory);
  }

 private:
  void add(const paint::Paint& paint, const paint::PaintMetrics& numbers) {
    const auto label = static_cast<std::uint32_t>(size());
    for (const std::string* text : {&paint.name, &paint.code}) {
      texts_ += *text;
      offsets_.push_back(static_cast<std::uint32_t>(texts_.size()));
    }
    classes_.push_back(static_cast<std::uint8_t>(paint.paint_class));
    for (std::size_t i = 0; i < metrics_.size(); ++i) metrics_[i].push_back(numbers.*columns()[i].value);
    const std::vector<paint::LabReading> readings = comparable_rows(paint);
    if (readings.empty()) return;
    SectionKey key{paint::condition_of(paint), {}};
    for (const paint::LabReading& reading : readings) key.geometries.push_back(reading.geometry);
    SectionRows& section = sections_[std::move(key)];
    for (const auto& [geometry, lab] : readings) section.rows.insert(section.rows.end(), {lab.L, lab.a, lab.b});
    section.labels.push_back(label);
  }

  std::vector<std::uint32_t> offsets_ = {0};
  std::string texts_;
  std::vector<std::uint8_t> classes_;
  std::vector<std::vector<double>> metrics_ = std::vector<std::vector<double>>(columns().size());
  std::map<SectionKey, SectionRows> sections_;
};

struct Built {
  std::string bytes;
  double read_s = 0, build_s = 0;
};

Result<Built> build(const std::function<Result<std::optional<paint::Paint>>()>& next, const Json& directory,
                    const std::function<void(std::size_t)>& progress) {
  constexpr std::size_t kBatch = 4096;
  Builder builder;
  Built built;
  std::vector<paint::Paint> batch;
  for (bool more = true; more;) {
    batch.clear();
    const Stopwatch reading;
    while (more && batch.size() < kBatch) {
      GONIO_ASSIGN(auto paint, next());
      more = paint.has_value();
      if (more) batch.push_back(std::move(*paint));
    }
    built.read_s += reading.elapsed_s();
    const Stopwatch building;
    if (builder.size() + batch.size() > UINT32_MAX) return input_error("a library holds at most 4294967295 paints");
    GONIO_TRY(builder.add(batch));
    if (progress) progress(builder.size());
    built.build_s += building.elapsed_s();
  }
  const Stopwatch packing;
  built.bytes = builder.pack(directory);
  built.build_s += packing.elapsed_s();
  return built;
}

// Finds the pieces of a packed index, and checks that each of them lies inside it.
class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : bytes_(bytes) {}

  // Throws as the JSON library does, or std::out_of_range, where the file is damaged.
  template <class T>
  const T* array(const Json& at, std::size_t count) const {
    const auto offset = at.get<std::uint64_t>();
    if (offset % 64 != 0 || offset > bytes_.size() || count > (bytes_.size() - offset) / sizeof(T))
      throw std::out_of_range("array");
    return reinterpret_cast<const T*>(bytes_.data() + offset);
  }
  Json directory() const {
    Head head;
    if (bytes_.size() < sizeof head) throw std::out_of_range("head");
    std::memcpy(&head, bytes_.data(), sizeof head);
    if (head.magic != Head{}.magic || head.file_bytes != bytes_.size() || head.directory_at > bytes_.size() ||
        head.directory_bytes > bytes_.size() - head.directory_at || head.sum != sum_of_index(bytes_))
      throw std::out_of_range("head");
    return parse_json(bytes_.substr(head.directory_at, head.directory_bytes));
  }

 private:
  std::string_view bytes_;
};

// Why the mapped index does not belong to this state of the library and this program; empty if it does.
Result<std::string> staleness(const Json& directory, const Guard& guard, const std::string& library_path,
                              const std::string& version) {
  // Another version may have read the library otherwise.
  if (directory.value("program", "") != version) return std::string("another version of this program made it");
  if (directory.value("library_bytes", std::uint64_t{0}) != guard.bytes) return std::string("the library has changed");
  if (directory.value("library_changed_ns", std::int64_t{0}) == guard.changed_ns) return std::string();
  GONIO_ASSIGN(const std::uint64_t sum, checksum(library_path));
  if (directory.value("library_checksum", std::uint64_t{0}) == sum) return std::string();
  return std::string("the library has changed");
}

}  // namespace

bool geometry_order(const paint::Geometry& x, const paint::Geometry& y) {
  return std::tie(x.incidence_deg, x.reversed, x.aspecular_deg, x.out_of_plane, x.azimuth_deg) <
         std::tie(y.incidence_deg, y.reversed, y.aspecular_deg, y.out_of_plane, y.azimuth_deg);
}

std::vector<paint::LabReading> comparable_rows(const paint::Paint& paint) {
  std::vector<paint::LabReading> rows;
  if (paint.measurement && !paint.measurement->rows.empty()) {
    rows = paint.measurement->rows;
    std::ranges::stable_sort(rows, geometry_order, &paint::LabReading::geometry);
    const auto repeated = std::ranges::unique(rows, {}, &paint::LabReading::geometry);
    rows.erase(repeated.begin(), repeated.end());
  } else if (paint.appearance) {
    rows = paint::rows_of(*paint.appearance);
    std::ranges::sort(rows, geometry_order, &paint::LabReading::geometry);
  }
  return rows;
}

std::string index_path(const std::string& library_path) {
  return library_path + ".snapindex";
}

LibraryIndex::LibraryIndex() = default;
LibraryIndex::LibraryIndex(LibraryIndex&&) noexcept = default;
LibraryIndex& LibraryIndex::operator=(LibraryIndex&&) noexcept = default;
LibraryIndex::~LibraryIndex() = default;

std::size_t LibraryIndex::bytes() const {
  return bytes_->size();
}

double LibraryIndex::metric(std::size_t paint, const paint::MetricColumn& column) const {
  return metrics_[static_cast<std::size_t>(&column - columns().data()) * ((size_ + 7) / 8 * 8) + paint];
}

Result<LibraryIndex> LibraryIndex::view_of(std::unique_ptr<Bytes> bytes) try {
  const Unpacker unpacker(bytes->view());
  const Json directory = unpacker.directory();
  LibraryIndex index;
  index.size_ = directory.at("paints").get<std::size_t>();
  const auto text_bytes = directory.at("text_bytes").get<std::uint64_t>();
  index.offsets_ = unpacker.array<std::uint32_t>(directory.at("offsets"), 2 * index.size_ + 1);
  index.texts_ = unpacker.array<char>(directory.at("texts"), text_bytes);
  index.classes_ = unpacker.array<std::uint8_t>(directory.at("classes"), index.size_);
  const std::span offsets(index.offsets_, 2 * index.size_ + 1);
  if (!std::ranges::is_sorted(offsets) || offsets.back() > text_bytes) throw std::out_of_range("offsets");
  if (std::ranges::any_of(std::span(index.classes_, index.size_), [](std::uint8_t c) {
        return c > static_cast<std::uint8_t>(paint::PaintClass::kInterference);
      }))
    throw std::out_of_range("classes");
  // Columns stand in the order of columns(), a multiple of 64 bytes apart; a file of other columns is stale.
  const Json& kept = directory.at("metrics");
  if (kept.size() != columns().size()) throw std::out_of_range("metrics");
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const double* column = unpacker.array<double>(kept[i].at("at"), index.size_);
    if (i == 0) index.metrics_ = column;
    if (kept[i].at("name") != columns()[i].name || column != index.metrics_ + i * ((index.size_ + 7) / 8 * 8))
      throw std::out_of_range("metrics");
  }
  for (const Json& entry : directory.at("sections")) {
    LibrarySection section;
    section.condition = {entry.at("illuminant").get<std::string>(), entry.at("observer_deg").get<int>()};
    for (const Json& name : entry.at("geometries")) {
      GONIO_ASSIGN(const paint::Geometry geometry, paint::parse_geometry(name.get<std::string>()));
      section.geometries.push_back(geometry);
    }
    TreeView& tree = section.tree;
    tree.size = entry.at("paints").get<std::size_t>();
    tree.channels = 3 * section.geometries.size();
    if (tree.size > index.size_) throw std::out_of_range("paints");
    tree.blocks = unpacker.array<double>(entry.at("blocks"), tree.leaves() * tree.channels * kLeafSize);
    tree.boxes = unpacker.array<ChildBounds>(entry.at("boxes"), tree.nodes() * tree.channels);
    tree.labels = unpacker.array<std::uint32_t>(entry.at("labels"), tree.size);
    if (tree.size > 0 && *std::max_element(tree.labels, tree.labels + tree.size) >= index.size_)
      throw std::out_of_range("labels");
    index.sections_.push_back(std::move(section));
  }
  index.bytes_ = std::move(bytes);
  return index;
} catch (const std::exception&) {
  return input_error("the index is damaged or of another version");
}

Result<LibraryIndex> LibraryIndex::open(const std::string& library_path,
                                        const std::function<void(std::size_t)>& progress, const std::string& version) {
  const Stopwatch mapping;
  if (formats::paint_reference(library_path).name) {
    GONIO_ASSIGN(const formats::PaintSourcePointer source, formats::open_paints(library_path));
    GONIO_ASSIGN(LibraryIndex index, from_paints([&] { return source->next(); }));
    index.warnings_ = warnings_of(*source);
    index.note_ = "it holds some paints of a file";
    return Result(std::move(index));
  }
  GONIO_ASSIGN(const Guard guard, guard_of(library_path));
  const std::string path = index_path(library_path);
  std::string why = "there was none";
  if (auto bytes = Bytes::mapped(path)) {
    const std::string_view view = bytes->view();
    if (auto mapped = view_of(std::move(bytes)); mapped.ok()) {
      GONIO_ASSIGN(why, staleness(Unpacker(view).directory(), guard, library_path, version));
      if (why.empty()) {
        mapped->origin_ = Origin::kMapped;
        mapped->build_s_ = mapping.elapsed_s();
        return mapped;
      }
    } else {
      why = mapped.error().message;
    }
  }

  GONIO_ASSIGN(const formats::PaintSourcePointer source, formats::open_paints(library_path));
  const Stopwatch summing;
  GONIO_ASSIGN(const std::uint64_t sum, checksum(library_path));
  const double summing_s = summing.elapsed_s();
  GONIO_ASSIGN(Built built, build([&] { return source->next(); },
                                  {{"program", version},
                                   {"library_bytes", guard.bytes},
                                   {"library_changed_ns", guard.changed_ns},
                                   {"library_checksum", sum}},
                                  progress));
  const Stopwatch writing;
  const auto written = write_file(path, built.bytes);
  GONIO_ASSIGN(LibraryIndex index, view_of(std::make_unique<Bytes>(std::move(built.bytes))));
  index.warnings_ = warnings_of(*source);
  index.origin_ = written.ok() ? Origin::kBuilt : Origin::kInMemory;
  index.note_ = written.ok() ? why : written.error().message;
  index.read_s_ = built.read_s;
  index.build_s_ = summing_s + built.build_s + writing.elapsed_s();
  return index;
}

Result<LibraryIndex> LibraryIndex::from_paints(const std::function<Result<std::optional<paint::Paint>>()>& next) {
  GONIO_ASSIGN(Built built, build(next, Json::object(), {}));
  GONIO_ASSIGN(LibraryIndex index, view_of(std::make_unique<Bytes>(std::move(built.bytes))));
  index.read_s_ = built.read_s;
  index.build_s_ = built.build_s;
  return index;
}

Result<LibraryIndex> LibraryIndex::from_bytes(std::string bytes) {
  return view_of(std::make_unique<Bytes>(std::move(bytes)));
}

std::string_view LibraryIndex::content() const {
  return bytes_->view();
}

}  // namespace goniochrome::library
