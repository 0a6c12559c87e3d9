//! Whole objects, in a folder of this machine.

use excavator_store::{Options, StoreError, fingerprint, get, head, list, put, put_if_absent};

#[test]
fn an_object_is_written_once() {
    let folder = tempfile::tempdir().unwrap();
    let (url, options) = (format!("{}/done/one.json", folder.path().display()), Options::new());
    assert!(put_if_absent(&url, b"first", &options).unwrap());
    assert!(!put_if_absent(&url, b"second", &options).unwrap());
    assert_eq!(get(&url, &options).unwrap(), b"first");
    put(&url, b"third", &options).unwrap();
    assert_eq!(get(&url, &options).unwrap(), b"third");
    assert_eq!(head(&url, &options).unwrap().size, 5);
}

#[test]
fn of_many_that_write_one_does() {
    let folder = tempfile::tempdir().unwrap();
    let url = format!("{}/contested", folder.path().display());
    let writers: Vec<_> = (0..8)
        .map(|number: u8| {
            let url = url.clone();
            std::thread::spawn(move || put_if_absent(&url, &[number; 1000], &Options::new()).unwrap())
        })
        .collect();
    let winners = writers.into_iter().map(|writer| writer.join().unwrap()).filter(|won| *won).count();
    assert_eq!(winners, 1);
}

#[test]
fn a_list_names_what_can_be_read() {
    let folder = tempfile::tempdir().unwrap();
    for root in [folder.path().display().to_string(), format!("file://{}", folder.path().display())] {
        let options = Options::new();
        put(&format!("{root}/a/1"), b"1", &options).unwrap();
        put(&format!("{root}/a/b/2"), b"22", &options).unwrap();
        let found = list(&format!("{root}/a"), &options).unwrap();
        assert_eq!(found.iter().map(|one| one.size).collect::<Vec<_>>(), [1, 2]);
        assert!(found.iter().all(|one| one.url.starts_with(&root)), "{found:?}");
        assert_eq!(get(&found[1].url, &options).unwrap(), b"22");
        assert_eq!(list(&format!("{root}/nothing"), &options).unwrap(), []);
    }
}

#[test]
fn a_fingerprint_is_that_of_the_content() {
    let folder = tempfile::tempdir().unwrap();
    let (one, other) = (folder.path().join("one"), folder.path().join("other"));
    for place in [&one, &other] {
        std::fs::create_dir(place).unwrap();
        std::fs::write(place.join("bag.mcap"), "content").unwrap();
    }
    let of = |path: &std::path::Path| fingerprint(&path.display().to_string(), &Options::new()).unwrap();
    assert_eq!(of(&one), of(&other));
    assert!(of(&one.join("bag.mcap")).starts_with("sha256:"));
    std::fs::write(other.join("bag.mcap"), "Content").unwrap();
    assert_ne!(of(&one), of(&other));
}

#[test]
fn errors_say_what_is_wrong() {
    let told = |url: &str, options: &Options| get(url, options).unwrap_err();
    assert!(matches!(told("/no/such/file", &Options::new()), StoreError::DoesNotExist { .. }));
    assert!(matches!(told("ftp://host/file", &Options::new()), StoreError::Address { .. }));
    let options = Options::from([("enpoint".to_string(), "x".to_string())]);
    assert_eq!(
        told("s3://bucket/file", &options).to_string(),
        "s3://bucket/file: a store of this kind has no option \"enpoint\""
    );
}
