/// \file ids.h
/// Strong 32-bit ids: a vertex id cannot be passed where a cell id is wanted.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <ostream>

namespace hex {

/// Index of an entity, or "none". `Tag` only makes the types differ. Range: 0 .. 2^32 - 2; 2^32 - 1 means
/// "none".
template <class Tag>
class Id {
  public:
    using value_type = std::uint32_t;  ///< of the number inside
    /// The number that stands for "none".
    static constexpr value_type none_value = std::numeric_limits<value_type>::max();

    /// None.
    constexpr Id() = default;
    /// The id `value`, which must be in range: of a larger number only the lower 32 bits are kept.
    constexpr explicit Id(std::size_t value) : value_(static_cast<value_type>(value)) {}

    /// The number; `none_value` when there is none.
    constexpr value_type value() const { return value_; }
    /// For indexing arrays.
    constexpr std::size_t index() const { return value_; }
    /// It is not "none".
    constexpr bool valid() const { return value_ != none_value; }
    /// In the order of the numbers; "none" comes last.
    constexpr auto operator<=>(const Id&) const = default;

    /// Writes the number, or "none".
    friend std::ostream& operator<<(std::ostream& out, Id id) {
        return id.valid() ? out << id.value_ : out << "none";
    }

  private:
    value_type value_ = none_value;
};

/// The ids 0 .. count - 1 in ascending order, for range-based for loops.
template <class IdType>
class IdRange {
  public:
    /// Counts up from id to id.
    class iterator {
      public:
        using value_type = IdType;               ///< required by the standard library
        using difference_type = std::ptrdiff_t;  ///< required by the standard library
        /// At id 0.
        iterator() = default;
        /// At the id `index`.
        explicit iterator(std::size_t index) : index_(index) {}
        /// The id it is at.
        IdType operator*() const { return IdType(index_); }
        /// Steps to the next id.
        iterator& operator++() {
            ++index_;
            return *this;
        }
        /// Steps to the next id; returns where it was.
        iterator operator++(int) { return iterator(index_++); }
        /// Both are at the same id.
        bool operator==(const iterator&) const = default;

      private:
        std::size_t index_ = 0;
    };

    /// The ids below `count`, which is at most 2^32 - 1.
    explicit IdRange(std::size_t count) : count_(count) {}
    /// At id 0, or at the end when there are none.
    iterator begin() const { return iterator(0); }
    /// After the last id.
    iterator end() const { return iterator(count_); }
    /// Number of ids.
    std::size_t size() const { return count_; }

  private:
    std::size_t count_;
};

using VertexId = Id<struct VertexTag>;      ///< vertex of a hexahedral mesh
using CellId = Id<struct CellTag>;          ///< hexahedron
using HalfFaceId = Id<struct HalfFaceTag>;  ///< half-face: 6 * cell + local face
using EdgeId = Id<struct EdgeTag>;          ///< unique edge of a hexahedral mesh
using QuadId = Id<struct QuadTag>;          ///< boundary quadrilateral

}  // namespace hex

/// For ids as keys of unordered containers.
template <class Tag>
struct std::hash<hex::Id<Tag>> {
    /// Equal for equal ids.
    std::size_t operator()(hex::Id<Tag> id) const noexcept { return std::hash<std::uint32_t>{}(id.value()); }
};
