// stormcellar/base/interface.h -- the base class of interfaces. Objects are neither copied nor
// moved.
//
// Threads   No state.
#pragma once

namespace stormcellar {

class Interface {
  public:
    Interface(const Interface&) = delete;
    Interface& operator=(const Interface&) = delete;
    virtual ~Interface() = default;

  protected:
    Interface() = default;
};

}  // namespace stormcellar
