"""What the tests of the live nodes share."""
