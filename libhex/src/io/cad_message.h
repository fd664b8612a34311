/// \file cad_message.h
/// Triangles of a CAD model, or the error that reading it gave, as bytes and back: what a child process
/// sends.
#pragma once

#include "io/cad_shape.h"

#include <hex/base/error.h>

#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace hex::io {

class ByteWriter {
  public:
    template <class T>
    void value(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    template <class T>
    void list(const T* values, std::size_t count) {
        static_assert(std::is_trivially_copyable_v<T>);
        value(count);
        bytes_.append(reinterpret_cast<const char*>(values), count * sizeof(T));
    }
    void text(const std::string& text) { list(text.data(), text.size()); }
    std::string take() { return std::move(bytes_); }

  private:
    std::string bytes_;
};

/// Reads what ByteWriter wrote, in the same order; Error{bad_input} when there are too few bytes.
class ByteReader {
  public:
    explicit ByteReader(const std::string& bytes) : bytes_(bytes) {}
    template <class T>
    T value() {
        T value;
        take(&value, sizeof value);
        return value;
    }
    template <class T>
    std::vector<T> list() {
        const auto count = value<std::size_t>();
        require(count <= (bytes_.size() - at_) / sizeof(T));
        std::vector<T> values(count);
        if (count > 0) take(values.data(), count * sizeof(T));
        return values;
    }
    std::string text() {
        const std::vector<char> letters = list<char>();
        return {letters.begin(), letters.end()};
    }

  private:
    static void require(bool enough) {
        if (!enough) throw Error(ErrorKind::bad_input, "is damaged: reading it ends early");
    }
    void take(void* to, std::size_t count) {
        require(count <= bytes_.size() - at_);
        std::memcpy(to, bytes_.data() + at_, count);
        at_ += count;
    }

    const std::string& bytes_;
    std::size_t at_ = 0;
};

}  // namespace hex::io
