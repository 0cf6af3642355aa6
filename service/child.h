// service/child.h -- starts a program beside the service and reads its output.
//
// The program has no input, default signals, a process group of its own (so that Ctrl-C in a
// terminal reaches only the service) and a lower priority. If memory runs out, the system kills the
// program before it kills the service. The program inherits no open files of the service. Its
// output is read line by line.
//
// Threads   One thread. If the child uses PR_SET_PDEATHSIG, that thread must live as long as the
//           child, because the signal comes when the thread ends.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <sys/types.h>

#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/result.h"

namespace stormcellar {

// Reads lines from a pipe. Never blocks.
class LineReader {
  public:
    static constexpr std::size_t longest_line = 4096;  // the rest of a longer line is dropped

    LineReader() = default;
    explicit LineReader(Descriptor descriptor) : descriptor_(std::move(descriptor)) {}

    // Returns the pipe, for poll(), or -1 once read() has reached the end of the output.
    [[nodiscard]] int descriptor() const { return descriptor_.number(); }
    // Returns the lines that have arrived. At the end of the output, also returns a last line that
    // has no line end. Reads at most 64 KiB in a call.
    std::vector<std::string> read();

  private:
    void take(std::string_view bytes, std::vector<std::string>& lines);

    Descriptor descriptor_;
    std::string line_;
};

class Child {
  public:
    // Starts the program. Errors: not_found, permission or io.
    static Result<Child> start(const std::filesystem::path& program,
                               const std::vector<std::string>& arguments);
    Child(Child&& other) noexcept;
    Child& operator=(Child&& other) noexcept;
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child();  // kills the program and waits for its end

    [[nodiscard]] pid_t id() const { return id_; }
    // Returns a descriptor that is readable once the program has ended.
    [[nodiscard]] int descriptor() const { return descriptor_.number(); }
    void signal(int number) const;
    // Returns how the program ended, as "status 1" or "signal 9"; empty while the program runs.
    [[nodiscard]] std::string ended();

    LineReader out, err;

  private:
    Child(pid_t id, Descriptor descriptor) : id_(id), descriptor_(std::move(descriptor)) {}
    void kill();

    pid_t id_ = 0;  // 0: there is no process, or wait() was called after its end
    Descriptor descriptor_;
    std::string ended_;
};

}  // namespace stormcellar
