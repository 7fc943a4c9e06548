// An array whose elements have no value until they are written. A std::vector writes zeros into its elements first, on
// one core. This one leaves that out, so that the threads that fill it are also the first that touch its memory.
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>

#include "base/large_pages.h"

namespace goniochrome {

template <class T>
class UnsetArray {
 public:
  static_assert(std::is_trivially_copyable_v<T>);

  UnsetArray() = default;
  explicit UnsetArray(std::size_t size) : data_(std::make_unique_for_overwrite<T[]>(size)), size_(size) {
    prefer_large_pages(data_.get(), size * sizeof(T));
  }

  std::size_t size() const { return size_; }
  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }

 private:
  std::unique_ptr<T[]> data_;
  std::size_t size_ = 0;
};

}  // namespace goniochrome
