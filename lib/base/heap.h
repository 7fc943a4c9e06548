// How a program that fills many large arrays one after the other takes its memory from the kernel.
#pragma once

namespace goniochrome {

// Makes the allocator keep the memory of arrays that are freed for the next ones. Without this glibc maps an array of
// some megabytes when it is made and unmaps it when it is freed, and the kernel clears each of its pages once more when
// it is touched for the first time. Call it once, before there are threads. With other C libraries it has no effect.
void keep_freed_memory();

}  // namespace goniochrome
