// The end of a tool where the system starts no more threads.
//
// The libraries that tools use do not survive that. OpenEXR and TBB abort; OSMesa waits for ever. A tool cannot catch it behind them, so thread_start.cpp defines pthread_create() itself. The
// dynamic loader takes the program's own function before that of the C library, for every library, also for those that
// are loaded late. The function hands each call on to the C library. Where the C library cannot start the thread
// (EAGAIN), the library that asked does not learn of it: the tool says what was lacking and ends at once. Sanitizers
// define pthread_create() for themselves, and keep it.
#pragma once

#include <string>

namespace goniochrome::cli {

// From now on, a thread that cannot start ends this process with exit status 3 and one message that begins with `tool`.
// In a child of made_by_child(), it ends the child, and the parent gets an error. Nothing stays behind: an unfinished
// file has no name, apart from file systems without unnamed files, where it stays as it does after a signal.
void expect_threads_to_run_out(const std::string& tool);

}  // namespace goniochrome::cli
