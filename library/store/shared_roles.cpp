#include "library/store/shared_roles.hpp"

namespace wale {

std::string grants_of_shared_index() {
  return R"(DO $$
BEGIN
  IF EXISTS (SELECT FROM pg_catalog.pg_roles WHERE rolname = 'wale_reader') THEN
    GRANT USAGE ON SCHEMA wale TO wale_reader;
    GRANT SELECT ON ALL TABLES IN SCHEMA wale TO wale_reader;
  END IF;
  IF EXISTS (SELECT FROM pg_catalog.pg_roles WHERE rolname = 'wale_curator') THEN
    GRANT USAGE ON SCHEMA wale TO wale_curator;
    GRANT SELECT ON ALL TABLES IN SCHEMA wale TO wale_curator;
    -- not of the table of facts, which has the version
    GRANT INSERT, UPDATE, DELETE ON wale.files, wale.materials, wale.words, wale.meant, wale.gone, wale.states TO wale_curator;
    GRANT UPDATE ON wale.present TO wale_curator;
  END IF;
END $$;
)";
}

std::string roles_of_shared_index() {
  return R"(-- Three roles for a shared index of Wale. Make the index first, and run this by a user who may make roles, as in
--   wale library index --roles | psql postgresql://ADMIN@HOST/DATABASE
-- Then make persons members:  GRANT wale_curator TO anna;
DO $$
DECLARE role text; item record;
BEGIN
  FOREACH role IN ARRAY ARRAY['wale_reader', 'wale_curator', 'wale_owner'] LOOP
    IF NOT EXISTS (SELECT FROM pg_catalog.pg_roles WHERE rolname = role) THEN
      EXECUTE pg_catalog.format('CREATE ROLE %I NOLOGIN', role);
    END IF;
  END LOOP;
  EXECUTE 'GRANT wale_owner TO CURRENT_USER';
  EXECUTE pg_catalog.format('GRANT CREATE ON DATABASE %I TO wale_owner', pg_catalog.current_database());
  EXECUTE 'ALTER SCHEMA wale OWNER TO wale_owner';
  FOR item IN SELECT tablename FROM pg_catalog.pg_tables WHERE schemaname = 'wale' LOOP
    EXECUTE pg_catalog.format('ALTER TABLE wale.%I OWNER TO wale_owner', item.tablename);
  END LOOP;
END $$;
REVOKE ALL ON SCHEMA wale FROM PUBLIC;
)" + grants_of_shared_index();
}

}  // namespace wale
