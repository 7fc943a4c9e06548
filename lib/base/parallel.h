// Loops that run on all cores, and whose results do not depend on how many cores there are.
#pragma once

#include <cstddef>
#include <functional>

namespace goniochrome {

// Caps the number of threads of every later parallel_for; 0 means one for each core. Call once, at the start.
void set_threads(int threads);

// The number of threads in force.
int threads();

// Calls body(begin, end) for the chunks [0,chunk), [chunk,2*chunk), ... that cover [0,n), on several threads.
// The chunks depend on n and chunk alone, so a body that writes only to its own range gives bit-identical results for
// any number of threads. Sums: one partial sum per chunk, added in order afterwards.
void parallel_for(std::size_t n, std::size_t chunk,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

// Calls visit(i) for each i of [0,n), `chunk` of them one after the other on a thread.
template <class Visit>
void parallel_each(std::size_t n, std::size_t chunk, const Visit& visit) {
  parallel_for(n, chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) visit(i);
  });
}

// Calls work(). While it waits for loops of its own, its thread takes up no other work, such as the next chunk of a
// loop that called this. So work() may hold a lock that such a chunk asks for too: elsewhere the thread would wait for
// itself.
void with_no_other_work(const std::function<void()>& work);

}  // namespace goniochrome
