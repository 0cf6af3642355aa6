// cli/shared/progress.h -- a progress bar on stderr, if stderr is a terminal and a bar is wanted.
#pragma once

#include <cstddef>
#include <string>

namespace stormcellar::cli {

class Progress {
  public:
    Progress(std::string what, std::size_t total, bool wanted);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    ~Progress();  // removes the bar

    void show(std::size_t done);
    // The total may differ from call to call, for example while it is still being determined.
    void show(std::size_t done, std::size_t total);
    void clear();  // call it before printing another message

  private:
    std::string what_;
    std::size_t total_;
    bool shown_;
};

// Returns "frames [#####.....]  6/12".
[[nodiscard]] std::string progress_line(const std::string& what, std::size_t done,
                                        std::size_t total);

}  // namespace stormcellar::cli
