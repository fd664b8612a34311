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
    using value_type = std::uint32_t;
    static constexpr value_type none_value = std::numeric_limits<value_type>::max();

    constexpr Id() = default;
    constexpr explicit Id(std::size_t value) : value_(static_cast<value_type>(value)) {}

    constexpr value_type value() const { return value_; }
    /// For indexing arrays.
    constexpr std::size_t index() const { return value_; }
    constexpr bool valid() const { return value_ != none_value; }
    constexpr auto operator<=>(const Id&) const = default;

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
    class iterator {
      public:
        using value_type = IdType;
        using difference_type = std::ptrdiff_t;
        iterator() = default;
        explicit iterator(std::size_t index) : index_(index) {}
        IdType operator*() const { return IdType(index_); }
        iterator& operator++() {
            ++index_;
            return *this;
        }
        iterator operator++(int) { return iterator(index_++); }
        bool operator==(const iterator&) const = default;

      private:
        std::size_t index_ = 0;
    };

    explicit IdRange(std::size_t count) : count_(count) {}
    iterator begin() const { return iterator(0); }
    iterator end() const { return iterator(count_); }
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

template <class Tag>
struct std::hash<hex::Id<Tag>> {
    std::size_t operator()(hex::Id<Tag> id) const noexcept { return std::hash<std::uint32_t>{}(id.value()); }
};
