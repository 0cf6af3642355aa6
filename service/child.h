// service/child.h -- starts a program beside the service and reads its output.
//
// The program has no input, default signals, a process group of its own (so that Ctrl-C in a
// terminal reaches only the service) and a lower priority; it is the first to be killed if memory
// runs out. It inherits none of the service's files. Its output is read line by line.
//
// Threads   One thread, which must live as long as the child if the child asks to be ended with its
//           parent (PR_SET_PDEATHSIG follows the thread).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "stormcellar/base/result.h"

namespace stormcellar {

// The reading end of a pipe, read by lines. Never blocks.
class LineReader {
  public:
    static constexpr std::size_t longest_line = 4096;  // the rest of a longer line is dropped

    LineReader() = default;
    explicit LineReader(int descriptor) : descriptor_(descriptor) {}
    LineReader(LineReader&& other) noexcept;
    LineReader& operator=(LineReader&& other) noexcept;
    LineReader(const LineReader&) = delete;
    LineReader& operator=(const LineReader&) = delete;
    ~LineReader();

    // for poll(); -1 once the other end is closed
    [[nodiscard]] int descriptor() const { return descriptor_; }
    // Returns the lines that have arrived; at the end also a last line without a line end. Reads at
    // most 64 KiB a call.
    std::vector<std::string> read();

  private:
    void close();
    void take(std::string_view bytes, std::vector<std::string>& lines);

    int descriptor_ = -1;
    std::string line_;
};

class Child {
  public:
    // Errors: not_found, permission or io if it could not be started.
    static Result<Child> start(const std::filesystem::path& program,
                               const std::vector<std::string>& arguments);
    Child(Child&& other) noexcept;
    Child& operator=(Child&& other) noexcept;
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child();  // kills it

    [[nodiscard]] pid_t id() const { return id_; }
    // readable once the program has ended
    [[nodiscard]] int descriptor() const { return descriptor_; }
    void signal(int number) const;
    // Returns "status 1" or "signal 9"; empty while it runs.
    [[nodiscard]] std::string ended();

    LineReader out, err;

  private:
    Child(pid_t id, int descriptor) : id_(id), descriptor_(descriptor) {}
    void release();

    pid_t id_ = 0;  // 0: there is no process, or it was waited for
    int descriptor_ = -1;
    std::string ended_;
};

}  // namespace stormcellar
