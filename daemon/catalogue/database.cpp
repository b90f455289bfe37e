#include "daemon/catalogue/database.h"

#include <fmt/format.h>
#include <soci/soci.h>
#include <unistd.h>

#include <chrono>
#include <deque>
#include <exception>
#include <random>
#include <thread>
#include <utility>

#include "core/support/utf8.h"

// As SOCI's own headers of the two have them, which bring those of SQLite and PostgreSQL along.
namespace soci {
extern "C" backend_factory const* factory_sqlite3();
extern "C" backend_factory const* factory_postgresql();
}  // namespace soci

namespace imunoise::catalogue {
namespace {

constexpr std::string_view kPostgres = "postgresql://";
constexpr std::string_view kInMemory = ":memory:";
constexpr int kPatience = 3;        // s that a SQLite file may be locked by another program
constexpr int kAttempts = 6;        // of a transaction that others disturb
constexpr int kLocks = 0x696d756e;  // our advisory locks in PostgreSQL, beside those of others

// The values of a statement, kept where SOCI finds them until it was executed.
class Bound {
 public:
  Bound(soci::statement& statement, const std::vector<Value>& values) {
    for (const Value& value : values) {
      std::visit([&](const auto& held) { bind(statement, held); }, value);
    }
  }

 private:
  void bind(soci::statement& statement, std::monostate) {
    statement.exchange(soci::use(nothing_, null_));
  }
  void bind(soci::statement& statement, std::int64_t value) {
    statement.exchange(soci::use(integers_.emplace_back(value)));
  }
  void bind(soci::statement& statement, double value) {
    statement.exchange(soci::use(reals_.emplace_back(value)));
  }
  void bind(soci::statement& statement, const std::string& value) {
    statement.exchange(soci::use(texts_.emplace_back(value)));
  }

  std::string nothing_;
  soci::indicator null_ = soci::i_null;
  std::deque<long long> integers_;
  std::deque<double> reals_;
  std::deque<std::string> texts_;
};

Value cell(const soci::row& row, std::size_t column) {
  if (row.get_indicator(column) == soci::i_null) return std::monostate{};
  switch (row.get_properties(column).get_data_type()) {
    case soci::dt_double:
      return row.get<double>(column);
    case soci::dt_integer:
      return std::int64_t{row.get<int>(column)};
    case soci::dt_long_long:
      return std::int64_t{row.get<long long>(column)};
    default:
      return row.get<std::string>(column);
  }
}

// Passwords of a connection stay secret.
std::string name_of(const std::string& where) {
  return where.starts_with(kPostgres) ? "the PostgreSQL catalogue" : where;
}

}  // namespace

struct Database::Session {
  std::string name;
  bool postgres = false;
  std::optional<std::filesystem::path> file;
  soci::session soci;
  bool disturbed = false;  // by another program, since a transaction began

  // The edge where SOCI's exceptions become errors.
  template <class Work>
  auto guarded(const Work& work) -> decltype(work()) {
    try {
      return work();
    } catch (const soci::soci_error& error) {
      disturbed = disturbed || is_disturbance(error);
      return told(error);
    } catch (const std::exception& error) {
      return told(error);
    }
  }
  // SQLite quotes what stands in a damaged file, bytes that are no text among it.
  tl::unexpected<Error> told(const std::exception& error) const {
    return fail(repaired_utf8(fmt::format("{}: {}", name, error.what())));
  }

  // PostgreSQL's deadlocks and failed serialisations have no category of their own; what else has
  // none fails again, a little later.
  bool is_disturbance(const soci::soci_error& error) const {
    if (!postgres)
      return std::string_view(error.what()).find("is locked") != std::string_view::npos;
    const auto category = error.get_error_category();
    return category == soci::soci_error::constraint_violation ||
           category == soci::soci_error::unknown ||
           category == soci::soci_error::unknown_transaction_state;
  }
};

namespace {

// Rolls back when it is left before the commit.
class Transaction {
 public:
  // SQLite: takes the lock at once. A transaction that reads first and writes later cannot get it
  // when another one does the same, however long it waits.
  Transaction(soci::session& session, bool postgres) : session_(session) {
    session_ << (postgres ? "begin" : "begin immediate");
  }
  ~Transaction() {
    if (committed_) return;
    try {
      session_ << "rollback";
    } catch (const std::exception&) {  // the connection is gone, and the transaction with it
    }
  }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit() {
    session_ << "commit";
    committed_ = true;
  }

 private:
  soci::session& session_;
  bool committed_ = false;
};

// Random waits, so that two programs do not collide again.
void wait_before(int attempt) {
  static thread_local std::minstd_rand random(
      static_cast<unsigned>(::getpid()) ^
      static_cast<unsigned>(std::chrono::steady_clock::now().time_since_epoch().count()));
  const int longest = 10 << attempt;
  std::this_thread::sleep_for(
      std::chrono::milliseconds(std::uniform_int_distribution<int>(1, longest)(random)));
}

}  // namespace

Database::Database(std::unique_ptr<Session> session) : session_(std::move(session)) {}
Database::~Database() = default;

Result<std::unique_ptr<Database>> Database::open(const std::string& where) {
  auto session = std::make_unique<Session>();
  session->name = name_of(where);
  session->postgres = where.starts_with(kPostgres);
  if (!session->postgres && where != kInMemory) session->file = where;
  if (where.find('"') != std::string::npos && !session->postgres)
    return fail(where + ": a catalogue's path may not hold a quotation mark");
  return session->guarded([&]() -> Result<std::unique_ptr<Database>> {
    if (session->postgres) {
      session->soci.open(*soci::factory_postgresql(), where.substr(kPostgres.size()));
      session->soci << "set client_min_messages to warning";  // else libpq prints
    } else {
      session->soci.open(*soci::factory_sqlite3(),
                         fmt::format("dbname=\"{}\" timeout={}", where, kPatience));
    }
    return std::unique_ptr<Database>(new Database(std::move(session)));
  });
}

Result<void> Database::execute(std::string_view statement, const std::vector<Value>& values) {
  const auto rows = query(statement, values);
  if (!rows) return tl::unexpected(rows.error());
  return {};
}

Result<std::vector<Row>> Database::query(std::string_view statement,
                                         const std::vector<Value>& values) {
  return session_->guarded([&]() -> Result<std::vector<Row>> {
    soci::statement prepared(session_->soci);
    const Bound bound(prepared, values);
    soci::row row;
    prepared.exchange(soci::into(row));
    prepared.alloc();
    prepared.prepare(std::string(statement));
    prepared.define_and_bind();
    std::vector<Row> out;
    for (bool more = prepared.execute(true); more; more = prepared.fetch()) {
      Row& cells = out.emplace_back();
      for (std::size_t c = 0; c < row.size(); ++c) cells.push_back(cell(row, c));
    }
    return out;
  });
}

Result<void> Database::transaction(const std::function<Result<void>()>& work,
                                   const std::string& lock, const std::function<void()>& again) {
  const auto attempt = [&]() -> Result<void> {
    Transaction all(session_->soci, session_->postgres);
    if (session_->postgres && !lock.empty()) {
      auto locked = execute("select cast(pg_advisory_xact_lock(:ours, hashtext(:lock)) as text)",
                            {std::int64_t{kLocks}, lock});
      if (!locked) return locked;
    }
    if (auto done = work(); !done) return done;
    all.commit();
    return {};
  };
  for (int done = 1;; ++done) {
    session_->disturbed = false;
    auto out = session_->guarded(attempt);
    if (out || !session_->disturbed || done == kAttempts) return out;
    wait_before(done);
    if (again) again();
  }
}

const std::optional<std::filesystem::path>& Database::file() const { return session_->file; }

std::int64_t integer(const Value& value) {
  const auto* const held = std::get_if<std::int64_t>(&value);
  return held == nullptr ? 0 : *held;
}

double real(const Value& value) {
  const auto* const held = std::get_if<double>(&value);
  return held == nullptr ? 0.0 : *held;
}

std::string text(const Value& value) {
  const auto* const held = std::get_if<std::string>(&value);
  return held == nullptr ? "" : *held;
}

}  // namespace imunoise::catalogue
