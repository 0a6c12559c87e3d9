//! Energy: storage, supply and the power of each effect ([A] Eq. 9-12).
