// tests/fault/steering_file.h -- the test's side of failing_calls.h.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/fault/failing_calls.h"

namespace stormcellar::fault {

class SteeringFile {
  public:
    // Calls of these kinds below these directories (three at most) are counted, and none fails.
    SteeringFile(const std::filesystem::path& file, const std::vector<std::filesystem::path>& below,
                 std::uint32_t kinds);
    SteeringFile(const SteeringFile&) = delete;
    SteeringFile& operator=(const SteeringFile&) = delete;
    ~SteeringFile();

    Steering* operator->() const { return steering_; }
    // From this call on, `count` calls fail; with UINT64_MAX, all until end().
    void fail(std::uint64_t from, std::uint64_t count, int error_number);
    void end() { steering_->to = 0; }
    // Returns the environment for the daemon.
    [[nodiscard]] std::map<std::string, std::string> environment() const;

  private:
    std::filesystem::path file_;
    Steering* steering_ = nullptr;
};

}  // namespace stormcellar::fault
