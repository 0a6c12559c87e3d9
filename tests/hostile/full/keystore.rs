//! Key stores as SROS2 makes them (`ros2 security create_keystore`, `create_enclave`), by the `openssl` command.

use std::path::{Path, PathBuf};
use std::process::Command;

/// A key store; the files are gone when it is dropped.
pub struct Keystore {
    folder: tempfile::TempDir,
}

/// What an enclave may do beside the topics that every node has: patterns of topics to publish.
pub struct Enclave {
    /// `/name`.
    pub name: &'static str,
    /// Topics in DDS, such as `rt/arm/*`.
    pub publishes: &'static [&'static str],
}

/// Topics that every node of ROS publishes; all topics may be read.
const COMMON: [&str; 6] = ["ros_discovery_info", "rt/rosout", "rt/parameter_events", "rt/diagnostics", "rq/*", "rr/*"];

fn openssl(folder: &Path, words: &[&str]) {
    let output = Command::new("openssl").args(words).current_dir(folder).output().unwrap();
    assert!(output.status.success(), "openssl {words:?}: {}", String::from_utf8_lossy(&output.stderr));
}

impl Keystore {
    /// Keys for some enclaves; `protection` is that of whole messages: `SIGN` as SROS2 has it, or `ENCRYPT`.
    pub fn new(enclaves: &[Enclave], protection: &str) -> Keystore {
        let keystore = Keystore { folder: tempfile::tempdir().unwrap() };
        let root = keystore.path();
        for folder in ["public", "private", "enclaves"] {
            std::fs::create_dir(root.join(folder)).unwrap();
        }
        for authority in ["identity_ca", "permissions_ca"] {
            let (key, certificate) = (format!("private/{authority}.key.pem"), format!("public/{authority}.cert.pem"));
            let subject = format!("/CN={authority}");
            let curve = "ec_paramgen_curve:prime256v1";
            openssl(
                root,
                &[
                    "req",
                    "-x509",
                    "-newkey",
                    "ec",
                    "-pkeyopt",
                    curve,
                    "-nodes",
                    "-keyout",
                    &key,
                    "-out",
                    &certificate,
                    "-days",
                    "3650",
                    "-subj",
                    &subject,
                ],
            );
        }
        sign(root, &governance(protection), Path::new("enclaves/governance"));
        for enclave in enclaves {
            keystore.add(enclave);
        }
        keystore
    }

    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// What the nodes of an enclave are started with.
    pub fn environment<'e>(&'e self, enclave: &'e str) -> [(&'e str, &'e str); 4] {
        [
            ("ROS_SECURITY_ENABLE", "true"),
            ("ROS_SECURITY_STRATEGY", "Enforce"),
            ("ROS_SECURITY_KEYSTORE", self.path().to_str().unwrap()),
            ("ROS_SECURITY_ENCLAVE_OVERRIDE", enclave),
        ]
    }

    /// Where the files of an enclave are.
    pub fn folder(&self, enclave: &str) -> PathBuf {
        self.path().join("enclaves").join(enclave.trim_start_matches('/'))
    }

    fn add(&self, enclave: &Enclave) {
        let (root, folder) = (self.path(), self.folder(enclave.name));
        std::fs::create_dir_all(&folder).unwrap();
        for (from, to) in [
            ("public/identity_ca.cert.pem", "identity_ca.cert.pem"),
            ("public/permissions_ca.cert.pem", "permissions_ca.cert.pem"),
            ("enclaves/governance.p7s", "governance.p7s"),
        ] {
            std::fs::copy(root.join(from), folder.join(to)).unwrap();
        }
        // The name begins with a slash, which openssl would take for a separator.
        let subject = format!("/CN={}", enclave.name.replace('/', "\\/"));
        let curve = "ec_paramgen_curve:prime256v1";
        openssl(
            &folder,
            &[
                "req",
                "-newkey",
                "ec",
                "-pkeyopt",
                curve,
                "-nodes",
                "-keyout",
                "key.pem",
                "-out",
                "request.pem",
                "-subj",
                &subject,
            ],
        );
        let authority = root.join("public/identity_ca.cert.pem");
        let key = root.join("private/identity_ca.key.pem");
        openssl(
            &folder,
            &[
                "x509",
                "-req",
                "-in",
                "request.pem",
                "-CA",
                authority.to_str().unwrap(),
                "-CAkey",
                key.to_str().unwrap(),
                "-out",
                "cert.pem",
                "-days",
                "3650",
                "-set_serial",
                "1",
            ],
        );
        sign(root, &permissions(enclave), &folder.join("permissions"));
    }
}

/// Signs a document with the key of the permissions' authority: `NAME.xml` and `NAME.p7s`.
fn sign(root: &Path, document: &str, name: &Path) {
    let (xml, signed) = (root.join(name).with_extension("xml"), root.join(name).with_extension("p7s"));
    std::fs::write(&xml, document).unwrap();
    let [xml, signed] = [xml, signed].map(|path| path.to_str().unwrap().to_string());
    openssl(
        root,
        &[
            "smime",
            "-sign",
            "-text",
            "-in",
            &xml,
            "-out",
            &signed,
            "-signer",
            "public/permissions_ca.cert.pem",
            "-inkey",
            "private/permissions_ca.key.pem",
        ],
    );
}

/// The governance of SROS2, but for the protection of whole messages.
fn governance(protection: &str) -> String {
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_governance.xsd">
  <domain_access_rules>
    <domain_rule>
      <domains><id>0</id></domains>
      <allow_unauthenticated_participants>false</allow_unauthenticated_participants>
      <enable_join_access_control>true</enable_join_access_control>
      <discovery_protection_kind>ENCRYPT</discovery_protection_kind>
      <liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>
      <rtps_protection_kind>{protection}</rtps_protection_kind>
      <topic_access_rules>
        <topic_rule>
          <topic_expression>*</topic_expression>
          <enable_discovery_protection>true</enable_discovery_protection>
          <enable_liveliness_protection>true</enable_liveliness_protection>
          <enable_read_access_control>true</enable_read_access_control>
          <enable_write_access_control>true</enable_write_access_control>
          <metadata_protection_kind>ENCRYPT</metadata_protection_kind>
          <data_protection_kind>ENCRYPT</data_protection_kind>
        </topic_rule>
      </topic_access_rules>
    </domain_rule>
  </domain_access_rules>
</dds>
"#
    )
}

fn permissions(enclave: &Enclave) -> String {
    let topic = |name: &&str| format!("            <topic>{name}</topic>\n");
    let publishes: String = COMMON.iter().chain(enclave.publishes).map(topic).collect();
    let name = enclave.name;
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_permissions.xsd">
  <permissions>
    <grant name="{name}">
      <subject_name>CN={name}</subject_name>
      <validity>
        <not_before>2020-01-01T00:00:00</not_before>
        <not_after>2120-01-01T00:00:00</not_after>
      </validity>
      <allow_rule>
        <domains><id>0</id></domains>
        <publish>
          <topics>
{publishes}          </topics>
        </publish>
        <subscribe>
          <topics>
            <topic>*</topic>
          </topics>
        </subscribe>
      </allow_rule>
      <default>DENY</default>
    </grant>
  </permissions>
</dds>
"#
    )
}
