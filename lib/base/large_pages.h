// Memory on large pages. A page is handed out when it is first touched, which takes the kernel longer than what most of
// this project does with the 4 kB on it: of a start that drew one picture, a fifth was that. Where the system keeps
// large pages for those who ask, as Linux does by default or on request, an array of megabytes is handed out in steps
// of 2 MB.
#pragma once

#include <cstddef>
#include <vector>

namespace goniochrome {

// Asks for large pages under bytes that were allocated and not touched yet. Does nothing for arrays of less than 4 MB,
// nor where the system has none.
void prefer_large_pages(void* begin, std::size_t bytes);

// values.resize(size), on large pages where it grows.
template <class T>
void resize_on_large_pages(std::vector<T>& values, std::size_t size) {
  if (size > values.capacity()) {
    values.reserve(size);
    prefer_large_pages(values.data() + values.size(), (size - values.size()) * sizeof(T));
  }
  values.resize(size);
}

}  // namespace goniochrome
