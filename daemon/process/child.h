// daemon/process/child.h -- a program that runs beside the daemon and is listened to.
//
// It has no input, default signals, a process group of its own (Ctrl-C in a terminal is the
// daemon's), a lower priority and is the first to go when memory is short; of the daemon's files it
// has none. What it prints comes line by line.
// Thread contract: one thread, which must live as long as the child where that asks to be ended
// with its parent (PR_SET_PDEATHSIG goes by the thread).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

// Where a program of this name is: beside this one, else on PATH; empty: nowhere.
[[nodiscard]] std::filesystem::path find_program(std::string_view name);

// The reading end of a pipe, by lines. Never blocks.
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

    // To poll; -1 once the other end is closed.
    [[nodiscard]] int descriptor() const { return descriptor_; }
    // The lines that have come; at the end also what had no end of line. At most 64 KiB a call.
    std::vector<std::string> read();

  private:
    void close();
    void take(std::string_view bytes, std::vector<std::string>& lines);

    int descriptor_ = -1;
    std::string line_;
};

class Child {
  public:
    // not_found, permission, io: why it could not be started.
    static Result<Child> start(const std::filesystem::path& program,
                               const std::vector<std::string>& arguments);
    Child(Child&& other) noexcept;
    Child& operator=(Child&& other) noexcept;
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child();  // kills it

    [[nodiscard]] pid_t id() const { return id_; }
    // Readable when it has ended.
    [[nodiscard]] int descriptor() const { return descriptor_; }
    void signal(int number) const;
    // "status 1", "signal 9"; empty while it runs.
    [[nodiscard]] std::string ended();

    LineReader out, err;

  private:
    Child(pid_t id, int descriptor) : id_(id), descriptor_(descriptor) {}
    void release();

    pid_t id_ = 0;  // 0: there is none, or it was waited for
    int descriptor_ = -1;
    std::string ended_;
};

}  // namespace stormcellar::daemon
