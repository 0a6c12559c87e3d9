//! DDS Security settings from the environment variables and the key store of ROS 2 (SROS2).

use std::path::{Path, PathBuf};

use super::RosError;

const ENABLE: &str = "ROS_SECURITY_ENABLE";
const STRATEGY: &str = "ROS_SECURITY_STRATEGY";
const KEYSTORE: &str = "ROS_SECURITY_KEYSTORE";
const OVERRIDE: &str = "ROS_SECURITY_ENCLAVE_OVERRIDE";

/// Files of an enclave that a participant needs.
const FILES: [&str; 6] =
    ["identity_ca.cert.pem", "cert.pem", "key.pem", "permissions_ca.cert.pem", "governance.p7s", "permissions.p7s"];
/// List of revoked certificates, which RustDDS does not read.
const REVOKED: &str = "crl.pem";

/// Whether this build supports DDS Security.
const BUILT_IN: bool = cfg!(feature = "security");

/// How participants are secured.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Security {
    /// No security.
    #[default]
    Off,
    /// With the keys of the enclave in this folder.
    Enclave(PathBuf),
}

/// The selected security and its warnings.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Chosen {
    pub security: Security,
    /// Warnings for the user.
    pub warnings: Vec<String>,
}

/// Reads the variables. `enclave` is the one from the command line (`--enclave`).
///
/// # Errors
/// [`RosError::Environment`] for invalid values, [`RosError::Security`] if `Enforce` requires what is not available.
pub(super) fn choose(lookup: impl Fn(&str) -> Option<String>, enclave: Option<&str>) -> Result<Chosen, RosError> {
    choose_for(BUILT_IN, lookup, enclave)
}

fn choose_for(
    built_in: bool,
    lookup: impl Fn(&str) -> Option<String>,
    enclave: Option<&str>,
) -> Result<Chosen, RosError> {
    let value = |name: &str| lookup(name).filter(|text| !text.is_empty());
    // ROS 2 takes any other value for "no", even "True". But a user who writes "True" wants security.
    let enabled = match value(ENABLE).as_deref() {
        None | Some("false") => false,
        Some("true") => true,
        Some(other) => return Err(wrong(ENABLE, other, "neither true nor false")),
    };
    let enforced = match value(STRATEGY).as_deref() {
        None | Some("Permissive") => false,
        Some("Enforce") => true,
        Some(other) => return Err(wrong(STRATEGY, other, "neither Enforce nor Permissive")),
    };
    if !enabled {
        return Ok(Chosen { security: Security::Off, warnings: Vec::new() });
    }
    let name = value(OVERRIDE).or_else(|| enclave.map(str::to_string)).unwrap_or_else(|| "/".to_string());
    let found = if built_in {
        folder(value(KEYSTORE).as_deref(), &name)
    } else {
        Err("this build has no DDS Security: build it with `--features security`".to_string())
    };
    match found {
        Ok((folder, None)) => Ok(Chosen { security: Security::Enclave(folder), warnings: Vec::new() }),
        Ok((_, Some(problem))) if enforced => Err(refused(problem)),
        Ok((folder, Some(problem))) => Ok(Chosen { security: Security::Enclave(folder), warnings: vec![problem] }),
        Err(problem) if enforced => Err(refused(problem)),
        Err(problem) => {
            let warning = format!("{problem}; {STRATEGY} is not Enforce: joining without security");
            Ok(Chosen { security: Security::Off, warnings: vec![warning] })
        }
    }
}

fn wrong(variable: &'static str, value: &str, problem: &str) -> RosError {
    RosError::Environment { variable, value: value.to_string(), problem: problem.to_string() }
}

fn refused(problem: String) -> RosError {
    RosError::Security { strategy: "Enforce", problem }
}

/// The folder of an enclave with all its files, and a warning for files that have no effect.
fn folder(keystore: Option<&str>, enclave: &str) -> Result<(PathBuf, Option<String>), String> {
    let keystore = keystore.ok_or_else(|| format!("{KEYSTORE} is not set"))?;
    let word =
        |word: &str| !word.is_empty() && word.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
    let relative = enclave.strip_prefix('/').filter(|rest| rest.is_empty() || rest.split('/').all(word));
    let relative =
        relative.ok_or_else(|| format!("\"{enclave}\" is not the name of an enclave: /name or /group/name"))?;
    let folder = Path::new(keystore).join("enclaves").join(relative);
    let missing: Vec<&str> = FILES.into_iter().filter(|file| std::fs::File::open(folder.join(file)).is_err()).collect();
    if !missing.is_empty() {
        return Err(format!("enclave {enclave} cannot be read: {} has no {}", folder.display(), missing.join(", ")));
    }
    let revoked = folder.join(REVOKED);
    let problem = revoked.exists().then(|| format!("{} is not followed: revoked peers are let in", revoked.display()));
    Ok((folder, problem))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn choose(built_in: bool, pairs: &[(&str, &str)], enclave: Option<&str>) -> Result<Chosen, RosError> {
        let lookup = |name: &str| pairs.iter().find(|(key, _)| *key == name).map(|(_, value)| value.to_string());
        choose_for(built_in, lookup, enclave)
    }

    /// A key store with one enclave; the files are empty.
    fn keystore(enclave: &str) -> tempfile::TempDir {
        let keystore = tempfile::tempdir().unwrap();
        let folder = keystore.path().join("enclaves").join(enclave);
        std::fs::create_dir_all(&folder).unwrap();
        FILES.iter().for_each(|file| std::fs::write(folder.join(file), "").unwrap());
        keystore
    }

    #[test]
    fn without_the_switch_nothing_is_secured() {
        for pairs in [&[][..], &[(ENABLE, "false"), (STRATEGY, "Enforce")], &[(ENABLE, "")]] {
            assert_eq!(choose(true, pairs, None).unwrap().security, Security::Off);
        }
    }

    #[test]
    fn values_that_look_like_security_are_not_taken_for_none() {
        for pairs in [[(ENABLE, "True"), (STRATEGY, "Enforce")], [(ENABLE, "true"), (STRATEGY, "enforce")]] {
            assert!(matches!(choose(true, &pairs, None), Err(RosError::Environment { .. })), "{pairs:?}");
        }
    }

    #[test]
    fn enforce_refuses_what_permissive_warns_of() {
        let keystore = keystore("arm");
        let path = keystore.path().to_str().unwrap();
        std::fs::remove_file(keystore.path().join("enclaves/arm/key.pem")).unwrap();
        let other = self::keystore("arm");
        std::fs::write(other.path().join("enclaves/arm/crl.pem"), "").unwrap();
        let other = other.path().to_str().unwrap();
        for (built_in, keystore, enclave, word) in [
            (false, Some(path), "/arm", "--features security"),
            (true, None, "/arm", "ROS_SECURITY_KEYSTORE is not set"),
            (true, Some(path), "/arm", "has no key.pem"),
            (true, Some(path), "/nobody", "enclave /nobody cannot be read"),
            (true, Some(path), "arm", "not the name of an enclave"),
            (true, Some(path), "/../arm", "not the name of an enclave"),
            (true, Some(other), "/arm", "crl.pem is not followed"),
        ] {
            let mut pairs = vec![(ENABLE, "true"), (STRATEGY, "Enforce")];
            pairs.extend(keystore.map(|path| (KEYSTORE, path)));
            let error = choose(built_in, &pairs, Some(enclave)).unwrap_err().to_string();
            assert!(error.contains(word) && !error.contains('\n'), "{error}");
            pairs[1].1 = "Permissive";
            let chosen = choose(built_in, &pairs, Some(enclave)).unwrap();
            assert!(chosen.warnings[0].contains(word), "{chosen:?}");
        }
    }

    #[test]
    fn the_enclave_is_found_as_ros_finds_it() {
        let keystore = keystore("arm/simulator");
        let path = keystore.path().to_str().unwrap();
        let expected = keystore.path().join("enclaves/arm/simulator");
        let pairs = [(ENABLE, "true"), (STRATEGY, "Enforce"), (KEYSTORE, path)];
        let of_argument = choose(true, &pairs, Some("/arm/simulator")).unwrap();
        assert_eq!(of_argument, Chosen { security: Security::Enclave(expected.clone()), warnings: Vec::new() });
        let of_variable = [pairs[0], pairs[1], pairs[2], (OVERRIDE, "/arm/simulator")];
        assert_eq!(choose(true, &of_variable, Some("/other")).unwrap().security, Security::Enclave(expected));
    }
}
