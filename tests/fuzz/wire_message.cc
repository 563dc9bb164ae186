#include "tests/fuzz/wire_message.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace visavis {
namespace {

void Append(std::uint64_t value, int num_bytes, Bytes* bytes) {
  for (int shift = 8 * num_bytes - 8; shift >= 0; shift -= 8) {
    bytes->push_back(static_cast<std::uint8_t>(value >> shift));
  }
}

class Writer {
 public:
  Writer(const LcmSchema& schema, int max_count, Random* random)
      : schema_(schema), max_count_(max_count), random_(random) {}

  void Struct(const std::string& type) {
    const LcmStruct& declared = schema_.at(type);
    std::map<std::string, int> counts;
    for (const LcmField& field : declared.fields) {
      const std::vector<int> element_bytes = BytesCountedBy(field.name, declared);
      if (!element_bytes.empty()) {
        const int count = random_->Index(max_count_ + 1);
        counts[field.name] = count;
        Length(count, MinEncodedSize(schema_, field.type), false, element_bytes);
        continue;
      }
      int elements = 1;
      for (const std::string& dim : field.dims) {
        elements *= counts.count(dim) > 0 ? counts[dim] : std::stoi(dim);
      }
      for (int i = 0; i < elements; ++i) Element(field.type);
    }
  }

  WireMessage message;

 private:
  // As WireLength::element_bytes; empty: the field counts nothing.
  std::vector<int> BytesCountedBy(const std::string& name, const LcmStruct& declared) {
    std::vector<int> bytes;
    for (const LcmField& field : declared.fields) {
      if (std::count(field.dims.begin(), field.dims.end(), name) == 0) continue;
      bytes.push_back(MinEncodedSize(schema_, field.type));
    }
    if (bytes.size() > 1) bytes.push_back(std::accumulate(bytes.begin(), bytes.end(), 0));
    return bytes;
  }

  void Length(int value, int num_bytes, bool is_string, std::vector<int> element_bytes) {
    message.lengths.push_back(
        {message.bytes.size(), num_bytes, is_string, std::move(element_bytes)});
    Append(static_cast<std::uint64_t>(value), num_bytes, &message.bytes);
  }

  void Element(const std::string& type) {
    if (type == "string") {
      const int letters = random_->Index(21);
      Length(letters + 1, 4, true, {1});
      for (int i = 0; i < letters; ++i) Append('a' + random_->Index(26), 1, &message.bytes);
      Append(0, 1, &message.bytes);
    } else if (IsPrimitive(type)) {
      Append(random_->Bits(), MinEncodedSize(schema_, type), &message.bytes);
    } else {
      Struct(type);
    }
  }

  const LcmSchema& schema_;
  const int max_count_;
  Random* const random_;
};

std::int64_t LyingLength(const WireLength& length, const Bytes& bytes, Random* random) {
  const std::int64_t truth = GetLength(length, bytes);
  const auto rest = static_cast<std::int64_t>(bytes.size() - length.offset) - length.num_bytes;
  const std::int64_t fits = rest / length.element_bytes.back();
  const std::int64_t lies[] = {-1,
                               0,
                               1,
                               truth - 1,
                               truth + 1,
                               fits,
                               fits + 1,
                               rest,
                               -truth,
                               1 << 15,
                               1 << 24,
                               1 << 29,
                               0x7fffffff,
                               0x7fffffff80,
                               -0x80000000LL,
                               -(1 << 15),
                               0x80 << 24,
                               0x7fff,
                               random->Index(1 << 20)};
  return lies[random->Index(std::size(lies))];
}

// A random place in [from, size); size where nothing lies there.
std::size_t Place(std::size_t from, std::size_t size, Random* random) {
  return from >= size ? size : from + random->Index(static_cast<int>(size - from));
}

void MutateOnce(const std::vector<WireLength>& lengths, Random* random, Bytes* bytes) {
  constexpr std::size_t kFingerprint = 8;
  const std::size_t place = Place(kFingerprint, bytes->size(), random);
  const auto at = bytes->begin() + static_cast<std::ptrdiff_t>(place);
  const std::ptrdiff_t run = std::min<std::ptrdiff_t>(1 + random->Index(16), bytes->end() - at);
  switch (random->Index(10)) {
    case 0:
      if (place < bytes->size()) *at = static_cast<std::uint8_t>(*at ^ (1 << random->Index(8)));
      break;
    case 1:
    case 2:
    case 3:
      if (!lengths.empty()) {
        const WireLength& length = lengths[random->Index(static_cast<int>(lengths.size()))];
        if (length.offset + length.num_bytes > bytes->size()) break;
        SetLength(length, LyingLength(length, *bytes, random), bytes);
      }
      break;
    case 4:
      bytes->resize(Place(0, bytes->size() + 1, random));
      break;
    case 5:
      for (int n = 1 + random->Index(40); n > 0; --n) Append(random->Bits(), 1, bytes);
      break;
    case 6:
      std::fill(at, at + run, random->Index(2) == 0 ? 0x00 : 0xff);
      break;
    case 7:
      bytes->erase(at, at + run);
      break;
    case 8: {
      const Bytes copy(at, at + run);
      bytes->insert(at, copy.begin(), copy.end());
      break;
    }
    default: {
      const std::size_t from = random->Index(8) == 0 ? 0 : kFingerprint;
      for (std::size_t i = from; i < bytes->size(); ++i) {
        (*bytes)[i] = static_cast<std::uint8_t>(random->Bits());
      }
    }
  }
}

}  // namespace

WireMessage RandomWireMessage(const LcmSchema& schema, const std::string& type, int max_count,
                              Random* random) {
  Writer writer(schema, max_count, random);
  Append(static_cast<std::uint64_t>(Fingerprint(schema, type)), 8, &writer.message.bytes);
  writer.Struct(type);
  return writer.message;
}

void SetLength(const WireLength& length, std::int64_t value, Bytes* bytes) {
  for (int i = length.num_bytes - 1; i >= 0; --i, value >>= 8) {
    (*bytes)[length.offset + i] = static_cast<std::uint8_t>(value);
  }
}

std::int64_t GetLength(const WireLength& length, const Bytes& bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < length.num_bytes; ++i) value = value << 8 | bytes[length.offset + i];
  const int unused_bits = 64 - 8 * length.num_bytes;  // shifted up and down: the sign goes along
  return static_cast<std::int64_t>(value << unused_bits) >> unused_bits;
}

Bytes Mutate(const WireMessage& message, Random* random) {
  Bytes bytes = message.bytes;
  for (int n = 1 + random->Index(3); n > 0; --n) MutateOnce(message.lengths, random, &bytes);
  return bytes;
}

std::vector<Bytes> Greediest(const WireMessage& message, std::size_t size) {
  // The message with one length filled, in each way.
  const auto fill = [](const WireLength& length, const Bytes& bytes) {
    const std::size_t rest = bytes.size() - length.offset - length.num_bytes;
    const std::int64_t largest = (std::int64_t{1} << (8 * length.num_bytes - 1)) - 1;
    std::vector<Bytes> filled(length.element_bytes.size(), bytes);
    for (std::size_t i = 0; i < filled.size(); ++i) {
      const auto fits = static_cast<std::int64_t>(rest) / length.element_bytes[i];
      SetLength(length, std::min(fits, largest), &filled[i]);
    }
    return filled;
  };
  Bytes padded = message.bytes;
  padded.resize(std::max(size, padded.size()));
  std::vector<Bytes> result;
  for (std::size_t i = 0; i < message.lengths.size(); ++i) {
    for (const Bytes& one : fill(message.lengths[i], padded)) {
      result.push_back(one);
      for (std::size_t k = i + 1; k < message.lengths.size(); ++k) {
        for (Bytes& two : fill(message.lengths[k], one)) result.push_back(std::move(two));
      }
    }
  }
  return result;
}

}  // namespace visavis
