// web/data/render_gate.h -- how many pictures are drawn at once, and how many requests wait for
// their turn.
//
// Threads   Many threads may use it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>

namespace stormcellar::web {

class RenderGate {
  public:
    // A permission to draw; its end lets the next one in.
    class Pass {
      public:
        explicit Pass(RenderGate* gate) : gate_(gate) {}
        Pass(Pass&& other) noexcept : gate_(other.gate_) { other.gate_ = nullptr; }
        Pass(const Pass&) = delete;
        Pass& operator=(const Pass&) = delete;
        Pass& operator=(Pass&&) = delete;
        ~Pass() {
            if (gate_ != nullptr) gate_->leave();
        }

      private:
        RenderGate* gate_;
    };

    RenderGate(int most, int most_waiting, std::chrono::milliseconds patience)
        : free_(most), may_wait_(most_waiting), patience_(patience) {}
    // Waits until fewer than `most` have a pass. None: patience ended before that, or as many wait
    // already as may.
    [[nodiscard]] std::optional<Pass> enter();

  private:
    void leave();

    std::mutex mutex_;
    std::condition_variable left_;
    int free_;
    int may_wait_;
    const std::chrono::milliseconds patience_;
};

}  // namespace stormcellar::web
