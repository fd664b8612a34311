/// \file registry.h
/// Exchangeable algorithms by name. Built-in methods register in their own .cpp; plug-ins register the same
/// way.
#pragma once

#include <hex/base/error.h>

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace hex {

/// Where the methods that register from now on come from: "built-in", or the path of the plug-in being
/// loaded.
std::string& registration_origin();

/// What `hexspline plugins` lists of a method.
struct MethodInfo {
    std::string stage;        ///< of its registry: "segment", "polycube", "map", ...
    std::string name;         ///< by which it is chosen, unique in its stage
    std::string description;  ///< what it does, in one line
    std::string origin;       ///< "built-in", or the path of the plug-in it comes from
};

/// The methods of one stage. `Interface` is its abstract class (`Segmenter`, `Mapper`, ...). Thread-safe.
template <class Interface>
class Registry {
  public:
    /// Makes a new object of a method. It is called under the lock of the registry, so it must not use that
    /// registry.
    using Factory = std::function<std::unique_ptr<Interface>()>;

    /// An empty registry; `stage` is the name of the stage in messages and lists.
    explicit Registry(std::string stage) : stage_(std::move(stage)) {}

    /// Adds a method. Throws Error{usage} when the name is taken.
    void add(const std::string& name, const std::string& description, Factory factory) {
        const std::lock_guard lock(mutex_);
        if (!methods_
                 .emplace(name, Entry{{stage_, name, description, registration_origin()}, std::move(factory)})
                 .second)
            throw Error(ErrorKind::usage, "stage '" + stage_ + "' already has a method '" + name + "'");
    }

    /// Makes the method of that name. Throws Error{usage}, listing the known names, when there is none, and
    /// Error{no_result} when its factory (a plug-in's, say) gives nothing.
    std::unique_ptr<Interface> make(const std::string& name) const {
        const std::lock_guard lock(mutex_);
        const auto found = methods_.find(name);
        if (found == methods_.end()) {
            std::string known;
            for (const auto& [key, entry] : methods_) known += (known.empty() ? "" : ", ") + key;
            throw Error(ErrorKind::usage, "stage '" + stage_ + "' has no method '" + name + "'", {},
                        "known methods: " + known);
        }
        std::unique_ptr<Interface> made = found->second.factory();
        if (!made) throw Error(ErrorKind::no_result, "the factory of method '" + name + "' gives no object");
        return made;
    }

    /// Whether there is a method of that name.
    bool contains(const std::string& name) const {
        const std::lock_guard lock(mutex_);
        return methods_.contains(name);
    }

    /// All methods in the order of their names.
    std::vector<MethodInfo> list() const {
        const std::lock_guard lock(mutex_);
        std::vector<MethodInfo> infos;
        for (const auto& [name, entry] : methods_) infos.push_back(entry.info);
        return infos;
    }

  private:
    struct Entry {
        MethodInfo info;
        Factory factory;
    };

    std::string stage_;
    mutable std::mutex mutex_;
    std::map<std::string, Entry> methods_;
};

/// A static object of this type in a .cpp registers `Method` under `name` when the library is loaded.
template <class Interface, class Method>
struct Register {
    /// Adds `Method`, made by its default constructor. Throws what Registry::add throws.
    Register(Registry<Interface>& registry, const std::string& name, const std::string& description) {
        registry.add(name, description, [] { return std::make_unique<Method>(); });
    }
};

}  // namespace hex
