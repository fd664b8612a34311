#include <hex/base/method_call.h>

#include <new>
#include <string_view>
#include <system_error>

namespace hex {
namespace {

constexpr const char* built_in = "built-in";

[[noreturn]] void tell(const MethodInfo& method, const std::string& what) {
    throw Error(ErrorKind::no_result, called(method) + " failed: " + what);
}

}  // namespace

bool is_out_of_memory_or_threads(const std::exception& problem) {
    if (dynamic_cast<const std::bad_alloc*>(&problem) != nullptr) return true;
    if (const auto* of_system = dynamic_cast<const std::system_error*>(&problem))
        return of_system->code() == std::errc::resource_unavailable_try_again ||
               of_system->code() == std::errc::not_enough_memory;
    // oneTBB names the call that failed.
    return std::string_view(problem.what()).starts_with("pthread_");
}

std::string message_of(const std::exception& problem) {
    const std::string_view message = problem.what();
    if (message.find_first_not_of(" \t\r\n") == std::string_view::npos)
        return "an exception without a message";
    return std::string(message);
}

std::string called(const MethodInfo& method) {
    std::string name = "method '" + method.name + "' of stage '" + method.stage + "'";
    if (method.origin != built_in) name += " (plug-in " + method.origin + ")";
    return name;
}

void rethrow_of(const MethodInfo& method) {
    // What escapes from a built-in method is a mistake of this program: it is left as it is.
    if (method.origin == built_in || method.name.empty()) throw;
    try {
        throw;
    } catch (const Error& error) {
        if (error.what() == std::string_view()) tell(method, message_of(error));
        throw;
    } catch (const std::exception& problem) {
        if (is_out_of_memory_or_threads(problem)) throw;
        tell(method, message_of(problem));
    } catch (...) {
        tell(method, "an exception of unknown kind");
    }
}

void refuse_result_of(const MethodInfo& method, const std::string& what, const Error& problem) {
    throw Error(ErrorKind::no_result, called(method) + " gives no " + what + ": " + problem.problem(),
                problem.where());
}

}  // namespace hex
