// tests/fault/steering_file.h -- lets a test steer failing_calls.so (failing_calls.h).
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
    // Counts calls of these kinds on files below these directories (three at most). No call fails
    // yet.
    SteeringFile(const std::filesystem::path& file, const std::vector<std::filesystem::path>& below,
                 std::uint32_t kinds);
    SteeringFile(const SteeringFile&) = delete;
    SteeringFile& operator=(const SteeringFile&) = delete;
    ~SteeringFile();

    Steering* operator->() const { return steering_; }
    // Makes `count` calls fail, beginning with call number `from`. If `count` is UINT64_MAX, all
    // calls from there fail until end().
    void fail(std::uint64_t from, std::uint64_t count, int error_number);
    void end() { steering_->to = 0; }
    [[nodiscard]] std::map<std::string, std::string> environment() const;

  private:
    std::filesystem::path file_;
    Steering* steering_ = nullptr;
};

}  // namespace stormcellar::fault
