// cli/shared/progress.h -- a bar on stderr, when stderr is a terminal and it is wanted.
#pragma once

#include <cstddef>
#include <string>

namespace stormcellar::cli {

class Progress {
  public:
    Progress(std::string what, std::size_t total, bool wanted);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    ~Progress();  // takes the bar away

    void show(std::size_t done);
    // With another total, which may grow while it is found out.
    void show(std::size_t done, std::size_t total);
    void clear();  // before another message is printed

  private:
    std::string what_;
    std::size_t total_;
    bool shown_;
};

// "frames [#####.....]  6/12"
[[nodiscard]] std::string progress_line(const std::string& what, std::size_t done,
                                        std::size_t total);

}  // namespace stormcellar::cli
