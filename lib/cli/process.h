// The first steps of a tool's process, and its end when memory runs out.
#pragma once

#include <string>

namespace goniochrome::cli {

// Opens /dev/null on the descriptors 0, 1 and 2 that are closed, because the next file that a tool opens would become
// its standard output or take its messages. Reading a closed standard input and writing to a closed standard output
// stay errors, since a missing input is never replaced and a lost output is no success; messages are lost.
void open_closed_descriptors();

// Makes crashes of libraries for want of memory an error message and exit status 3. A library may end the process where
// an allocation fails; where then no large block of addresses is to be had, want of memory is taken for the cause.
void expect_memory_to_run_out(const std::string& tool);

// True if a large block of addresses (512 MB) cannot be had any more.
bool is_short_of_memory();

}  // namespace goniochrome::cli
