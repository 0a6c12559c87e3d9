//! SQLite bags that bring a program of their own.

use rusqlite::Connection;

use crate::hostile::child::{run, worst};
use crate::hostile::fault::Fault;

const TOPICS: &str = "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
    serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);";
const MESSAGES: &str = "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,
    timestamp INTEGER NOT NULL, data BLOB NOT NULL);";
const ENDLESS: &str = "WITH RECURSIVE c(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM c)";

#[test]
fn an_endless_view_in_the_place_of_the_topics() {
    let folder = tempfile::tempdir().unwrap();
    let view = format!(
        "CREATE VIEW topics AS {ENDLESS} SELECT n AS id, 'topic ' || n AS name, 'a/b' AS type,
         'cdr' AS serialization_format, '' AS offered_qos_profiles FROM c;"
    );
    let messages = format!(
        "CREATE VIEW messages AS {ENDLESS} SELECT n AS rowid, 1 AS topic_id, n AS timestamp, zeroblob(1000000) AS data FROM c;"
    );
    // A column that is computed anew for each row, and a view that says it is a table.
    let computed = "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER,
         data BLOB GENERATED ALWAYS AS (zeroblob(50000000)) VIRTUAL);";
    let disguise = "PRAGMA writable_schema = on; UPDATE sqlite_master SET type = 'table' WHERE name = 'topics';";
    let mut runs = Vec::new();
    for (name, sql, part) in [
        ("topics", format!("{view}{MESSAGES}"), "topics is a view, not a table"),
        ("messages", format!("{TOPICS}{messages}"), "messages is a view, not a table"),
        ("computed", format!("{TOPICS}{computed}"), "the column data of messages is computed"),
        ("disguised", format!("{view}{MESSAGES}{disguise}"), "is a SQLite3 file that cannot be read"),
    ] {
        let file = format!("{name}.db3");
        Connection::open(folder.path().join(&file)).unwrap().execute_batch(&sql).unwrap();
        let info = run(folder.path(), &["info", &file], 10.0);
        info.refused(&[part]);
        runs.push(info);
    }
    Fault {
        group: "Files",
        tried: "an SQLite bag whose topics are an endless view",
        outcome: "only plain tables are asked, without functions of the file's own, and each question has an end",
    }
    .survived(&worst(&runs));
}

#[test]
fn a_database_of_a_million_topics_with_long_definitions() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bag.db3");
    let database = Connection::open(&path).unwrap();
    database.execute_batch(&format!("PRAGMA journal_mode = off; {TOPICS}{MESSAGES}")).unwrap();
    database
        .execute_batch(
            "CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT, encoding TEXT,
                 encoded_message_definition TEXT, type_description_hash TEXT);
             INSERT INTO message_definitions VALUES (1, 'a/b', 'ros2msg', replace(hex(zeroblob(250000)), '00', 'x '), '');
             WITH RECURSIVE c(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM c LIMIT 100000)
             INSERT INTO topics SELECT n, '/topic' || n, 'a/b', 'cdr', '' FROM c;",
        )
        .unwrap();
    drop(database);
    // Each topic has the definition of its type: 100 000 times half a megabyte.
    let info = run(folder.path(), &["info", "bag.db3"], 10.0);
    info.refused(&["the definitions of all topics together have", "the limit is 67108864"]);
    Fault {
        group: "Files",
        tried: "a database of 100 000 topics with a definition of half a megabyte",
        outcome: "refused when the definitions together reach 64 MiB",
    }
    .survived(&worst(&[info]));
}
