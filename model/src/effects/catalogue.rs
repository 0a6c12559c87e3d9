//! The effects available to a model.

use std::sync::{Arc, LazyLock};

use super::{Effect, built_in, nearest};

/// An effect, shared by several models.
pub type AnyEffect = Arc<dyn Effect>;

/// The effects available to a model: built-in effects and user effects. Copies are cheap.
#[derive(Debug, Clone)]
pub struct Catalogue {
    effects: Arc<[AnyEffect]>,
}

/// An effect name that is not in the catalogue.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown effect \"{name}\"{}; `excavator effects` lists all", did_you_mean(suggestion))]
#[non_exhaustive]
pub struct UnknownEffect {
    /// The requested name.
    pub name: String,
    /// The nearest name in the catalogue, if there is one.
    pub suggestion: Option<String>,
}

fn did_you_mean(suggestion: &Option<String>) -> String {
    suggestion.as_ref().map_or(String::new(), |name| format!(" (did you mean \"{name}\"?)"))
}

/// Two effects with the same name.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("there are two effects named \"{name}\"; give yours another name")]
#[non_exhaustive]
pub struct TwiceInCatalogue {
    /// The name.
    pub name: String,
}

impl Catalogue {
    /// The built-in effects.
    pub fn built_in() -> Catalogue {
        static BUILT_IN: LazyLock<Catalogue> = LazyLock::new(|| Catalogue { effects: built_in::built_in().into() });
        BUILT_IN.clone()
    }

    /// Only these effects.
    pub fn of(effects: Vec<AnyEffect>) -> Catalogue {
        Catalogue { effects: effects.into() }
    }

    /// The same catalogue with more effects, appended in order.
    ///
    /// # Errors
    /// [`TwiceInCatalogue`] if a name already exists, or occurs twice among the new effects.
    pub fn with(&self, more: impl IntoIterator<Item = AnyEffect>) -> Result<Catalogue, TwiceInCatalogue> {
        let mut names: std::collections::HashSet<String> =
            self.iter().map(|effect| effect.card().name.to_string()).collect();
        let mut effects = self.effects.to_vec();
        for effect in more {
            let name = effect.card().name.to_string();
            if !names.insert(name.clone()) {
                return Err(TwiceInCatalogue { name });
            }
            effects.push(effect);
        }
        Ok(Catalogue { effects: effects.into() })
    }

    /// Every effect: base effects of \[A\] first, then the candidates beyond them, then those of the user.
    pub fn iter(&self) -> std::slice::Iter<'_, AnyEffect> {
        self.effects.iter()
    }

    /// The effect with this name.
    ///
    /// # Errors
    /// [`UnknownEffect`] with the nearest existing name.
    pub fn find(&self, name: &str) -> Result<AnyEffect, UnknownEffect> {
        self.iter().find(|effect| effect.card().name == name).cloned().ok_or_else(|| UnknownEffect {
            name: name.to_string(),
            suggestion: nearest(name, self.iter().map(|effect| &*effect.card().name)),
        })
    }
}

impl<'a> IntoIterator for &'a Catalogue {
    type Item = &'a AnyEffect;
    type IntoIter = std::slice::Iter<'a, AnyEffect>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}
