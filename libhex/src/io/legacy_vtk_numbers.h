/// \file legacy_vtk_numbers.h
/// The numbers of a legacy VTK file, in text or binary, of any type.
#pragma once

#include "io/byte_order.h"
#include "io/number_array.h"
#include "io/text_scanner.h"

#include <hex/base/error.h>

#include <algorithm>
#include <array>
#include <span>

namespace hex::io {

/// Arrays of numbers between the words of the file.
class LegacyVtkNumbers {
  public:
    /// Number types of the format.
    enum class Type { bit, int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

    static std::size_t size_of(Type type) {
        switch (type) {
            case Type::bit:
            case Type::int8:
            case Type::uint8:
                return 1;
            case Type::int16:
            case Type::uint16:
                return 2;
            case Type::int32:
            case Type::uint32:
            case Type::float32:
                return 4;
            default:
                return 8;
        }
    }

    explicit LegacyVtkNumbers(const InputFile& file) : scanner_(file) {}

    TextScanner& scanner() { return scanner_; }
    bool binary() const { return binary_; }
    void set_binary(bool binary) { binary_ = binary; }

    Type type() {
        const std::string name = lower_case(scanner_.word("a number type"));
        struct Entry {
            const char* name;
            Type type;
        };
        static constexpr std::array entries = {
            Entry{"double", Type::float64}, Entry{"float", Type::float32}, Entry{"int", Type::int32},
            Entry{"unsigned_int", Type::uint32}, Entry{"long", Type::int64},
            Entry{"unsigned_long", Type::uint64}, Entry{"vtktypeint64", Type::int64},
            Entry{"vtktypeuint64", Type::uint64}, Entry{"vtktypeint32", Type::int32},
            Entry{"vtktypeuint32", Type::uint32},
            // Binary files hold vtkIdType as 32-bit numbers.
            Entry{"vtkidtype", Type::int32}, Entry{"short", Type::int16},
            Entry{"unsigned_short", Type::uint16}, Entry{"char", Type::int8},
            Entry{"signed_char", Type::int8}, Entry{"unsigned_char", Type::uint8}, Entry{"bit", Type::bit}};
        for (const Entry& entry : entries) {
            if (name == entry.name) return entry.type;
        }
        scanner_.unsupported("unknown number type " + in_quotes(name));
    }

    /// Before the numbers of an array: binary ones start on the next line and must all be there.
    void start_array(std::size_t count, Type type) {
        type_ = type;
        if (!binary_) {
            scanner_.check_count(static_cast<long long>(std::min<std::size_t>(count, INT64_MAX)),
                                 "the number of values", 2);
            return;
        }
        scanner_.rest_of_line();
        const std::size_t left = scanner_.text().size() - scanner_.position();
        const std::size_t needed = type == Type::bit ? (count + 7) / 8 : count;
        if (needed > left / size_of(type))
            fail_binary("the file ends within binary data of " + std::to_string(count) + " numbers");
    }

    [[noreturn]] void fail_binary(const std::string& what) const {
        throw Error(ErrorKind::bad_input, what, scanner_.file().byte_place(scanner_.position()));
    }
    [[noreturn]] void fail_value(const std::string& what) const {
        if (binary_) fail_binary(what);
        scanner_.fail(what);
    }

    template <class Number>
    Number take() {
        const auto value = load<Number>(scanner_.text().data() + scanner_.position(), std::endian::big);
        scanner_.seek(scanner_.position() + sizeof(Number));
        return value;
    }
    template <class Result>
    Result take_as() {
        switch (type_) {
            case Type::bit:
            case Type::uint8:
                return static_cast<Result>(take<std::uint8_t>());
            case Type::int8:
                return static_cast<Result>(take<std::int8_t>());
            case Type::int16:
                return static_cast<Result>(take<std::int16_t>());
            case Type::uint16:
                return static_cast<Result>(take<std::uint16_t>());
            case Type::int32:
                return static_cast<Result>(take<std::int32_t>());
            case Type::uint32:
                return static_cast<Result>(take<std::uint32_t>());
            case Type::int64:
                return static_cast<Result>(take<std::int64_t>());
            case Type::uint64:
                return static_cast<Result>(take<std::uint64_t>());
            case Type::float32:
                return static_cast<Result>(take<float>());
            case Type::float64:
                break;
        }
        return static_cast<Result>(take<double>());
    }
    long long next_integer() { return binary_ ? take_as<long long>() : scanner_.integer("a value"); }
    double next_real() { return binary_ ? take_as<double>() : scanner_.real("a value"); }
    void require_integers(Type type) const {
        if (type == Type::float32 || type == Type::float64 || type == Type::bit)
            scanner_.fail("this should be an integer type");
    }

    /// The next numbers of a text file; false, and nothing taken, when they are not all there and right.
    template <class Number>
    bool take_numbers(std::span<Number> numbers) {
        const auto end = parse_numbers(scanner_.text(), scanner_.position(), numbers);
        if (end) scanner_.seek(*end);
        return end.has_value();
    }

    /// Passes over an array of so many numbers.
    void skip_array(std::size_t count) {
        if (binary_) {
            const std::size_t bytes = type_ == Type::bit ? (count + 7) / 8 : count * size_of(type_);
            scanner_.seek(scanner_.position() + bytes);
        } else {
            // Values of skipped fields may be anything, nan too.
            for (std::size_t i = 0; i < count; ++i) scanner_.word("a value");
        }
    }

  private:
    TextScanner scanner_;
    bool binary_ = false;
    Type type_ = Type::int32;
};

}  // namespace hex::io
