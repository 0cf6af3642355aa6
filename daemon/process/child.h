// daemon/process/child.h -- a program that runs beside the daemon, and whose output the daemon
// reads.
//
// The child has no input, default signals, its own process group (Ctrl-C in a terminal is meant for
// the daemon) and a lower priority; it is the first to be killed when memory is short, and has none
// of the daemon's files. Its output comes line by line. Thread contract: one thread. It must live
// as long as the child if the child is to end with its parent, because PR_SET_PDEATHSIG refers to
// the thread.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

// The path of the program of this name: beside this program, or else on PATH; empty if there is
// none.
[[nodiscard]] std::filesystem::path find_program(std::string_view name);

// The reading end of a pipe, line by line. Never blocks.
class LineReader {
  public:
    static constexpr std::size_t longest_line = 4096;  // the rest of a longer one is dropped

    LineReader() = default;
    explicit LineReader(int descriptor) : descriptor_(descriptor) {}
    LineReader(LineReader&& other) noexcept;
    LineReader& operator=(LineReader&& other) noexcept;
    LineReader(const LineReader&) = delete;
    LineReader& operator=(const LineReader&) = delete;
    ~LineReader();

    // The descriptor to poll; -1 once the other end is closed.
    [[nodiscard]] int descriptor() const { return descriptor_; }
    // The lines that have come; at the end also a last line without a newline. At most 64 KiB a
    // call.
    std::vector<std::string> read();

  private:
    void close();
    void take(std::string_view bytes, std::vector<std::string>& lines);

    int descriptor_ = -1;
    std::string line_;
};

class Child {
  public:
    // Errors: not_found, permission or io: why the program cannot be started.
    static Result<Child> start(const std::filesystem::path& program,
                               const std::vector<std::string>& arguments);
    Child(Child&& other) noexcept;
    Child& operator=(Child&& other) noexcept;
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child();  // kills it

    [[nodiscard]] pid_t id() const { return id_; }
    // Readable when the child has ended.
    [[nodiscard]] int descriptor() const { return descriptor_; }
    void signal(int number) const;
    // "status 1", "signal 9"; empty while the child runs.
    [[nodiscard]] std::string ended();

    LineReader out, err;

  private:
    Child(pid_t id, int descriptor) : id_(id), descriptor_(descriptor) {}
    void release();

    pid_t id_ = 0;  // 0: there is no child, or it was waited for
    int descriptor_ = -1;
    std::string ended_;
};

}  // namespace stormcellar::daemon
