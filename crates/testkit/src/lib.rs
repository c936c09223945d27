//! Scenes, exact references and brute force for tests; not published.
