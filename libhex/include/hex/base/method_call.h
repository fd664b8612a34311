/// \file method_call.h
/// How a stage calls a method of its registry, which may be a plug-in's: what the method throws and what it
/// returns is told by the stage, with the name of the method.
#pragma once

#include <hex/base/registry.h>

#include <exception>
#include <memory>
#include <string>

namespace hex {

/// Whether an exception of the standard library or of oneTBB says that there is no more memory, or that no
/// more threads may be started, which is what too little memory for their stacks looks like.
bool is_out_of_memory_or_threads(const std::exception& problem);

/// What an exception says about itself; "an exception without a message" when that is nothing.
std::string message_of(const std::exception& problem);

/// Name, stage and, if it is not built in, plug-in of a method, for messages.
std::string called(const MethodInfo& method);

/// To be called in a handler: throws on what is being handled. Of a plug-in's method, that is
/// Error{no_result} with the method and what it threw, unless it threw an Error with a message, or is out of
/// memory or of threads.
[[noreturn]] void rethrow_of(const MethodInfo& method);

/// Throws `problem`, found in what a method returned, as Error{no_result} with the method.
/// \param what what the method should have given
[[noreturn]] void refuse_result_of(const MethodInfo& method, const std::string& what, const Error& problem);

/// A method of a registry in use by its stage.
template <class Interface>
class MethodCall {
  public:
    /// Throws what Registry::make throws, and what the factory throws as rethrow_of() says.
    MethodCall(const Registry<Interface>& registry, const std::string& name) {
        for (const MethodInfo& info : registry.list())
            if (info.name == name) info_ = info;
        method_ = guarded([&] { return registry.make(name); });
    }

    /// Returns work(method); what that throws comes on as rethrow_of() says.
    template <class Work>
    auto operator()(const Work& work) const {
        return guarded([&] { return work(*method_); });
    }

    /// Runs `check` on what the method returned: an Error of it becomes "method ... gives no `what`: ...",
    /// Error{no_result}.
    template <class Check>
    void require(const std::string& what, const Check& check) const {
        try {
            check();
        } catch (const Error& problem) {
            refuse_result_of(info_, what, problem);
        }
    }

  private:
    template <class Work>
    auto guarded(const Work& work) const {
        try {
            return work();
        } catch (...) {
            rethrow_of(info_);
        }
    }

    MethodInfo info_;
    std::unique_ptr<Interface> method_;
};

}  // namespace hex
