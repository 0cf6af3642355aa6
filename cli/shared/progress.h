// cli/shared/progress.h -- a progress bar on stderr, with the rate and the time left. The bar is
// shown only if stderr is a terminal and the caller wants it.
#pragma once

#include <cstddef>
#include <string>

#include "base/steady_time.h"

namespace stormcellar::cli {

class Progress {
  public:
    // If the total is 0, nothing is shown until show() gets a total.
    Progress(std::string what, std::size_t total, bool wanted);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    ~Progress();  // removes the bar

    void show(std::size_t done);
    // The total may change between calls, for example while it is still being counted.
    void show(std::size_t done, std::size_t total);
    void clear();  // call it before printing another message

  private:
    std::string what_;
    SteadyTime start_ = steady_now();
    std::size_t total_;
    bool shown_;
};

// Returns a line such as "frames [#####.....]  6/12, 2.5 a second, 3 s left". The line lacks the
// rate and the time left in the first second, before anything is done, and at the end.
[[nodiscard]] std::string progress_line(const std::string& what, std::size_t done,
                                        std::size_t total, double elapsed_s = 0);

}  // namespace stormcellar::cli
