// Values that take long to compute, kept for the next time that they are asked for.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

namespace goniochrome {

// Keeps at most kMost values and then begins anew, so that a stream of paints with ever other coats needs constant
// memory. Values that are in use stay valid. For any number of threads.
template <class Key, class Value>
class KeptValues {
 public:
  static constexpr std::size_t kMost = 1024;

  // The value of this key, which `make()` returns if it is not known. No lock is held meanwhile, since a parallel loop
  // in `make` may run other work that asks for the same key. Of threads that make a value at once the first one's stays.
  template <class Make>
  std::shared_ptr<const Value> get(const Key& key, const Make& make) {
    {
      const std::scoped_lock lock(mutex_);
      const auto found = values_.find(key);
      if (found != values_.end()) return found->second;
    }
    auto made = std::make_shared<const Value>(make());
    const std::scoped_lock lock(mutex_);
    if (values_.size() >= kMost) values_.clear();
    return values_.try_emplace(key, std::move(made)).first->second;
  }

 private:
  std::mutex mutex_;
  std::map<Key, std::shared_ptr<const Value>> values_;
};

}  // namespace goniochrome
